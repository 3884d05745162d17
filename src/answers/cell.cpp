#include "answers/state.hpp"
#include "core/decimal.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace isostat::answers {

namespace {

std::vector<std::string> moving(const Cell& cell) {
    std::vector<std::string> names;
    if (cell.keeps_shape) {
        return {"scale"};
    }
    for (std::size_t a = 0; a < most_axes; ++a) {
        if (cell.period_moves[a]) {
            names.emplace_back(axis_names[a]);
        }
    }
    for (std::size_t t = 0; t < most_tilts; ++t) {
        if (cell.tilt_moves[t]) {
            names.emplace_back(tilt_names[t]);
        }
    }
    return names;
}

/// The tilts in the order xy, xz, yz.
std::span<const double> tilts_of(const Packing& packing) {
    return std::span(packing.q).subspan(packing.length_at(packing.axes()), packing.tilts());
}

/// The text of a count, marked when it is only a bound.
std::string marked(int value, const Counting& c) {
    return fmt::format("{}{}", c.rank_exact == Verdict::proved ? "" : "<=", value);
}

/// One word of jamming: `jammed.NAME` in JSON.
void add_answer(Answer& out, const char* name, const JammingAnswer& answer) {
    out.line(fmt::format("jammed {}ly", name), "{}: {}", to_string(answer.verdict), answer.reason);
    Json& jammed = out.json["jammed"][name];
    jammed = {{"verdict", to_string(answer.verdict)}, {"reason", answer.reason}};
    if (answer.verdict == Verdict::undecided && answer.if_closed) {
        const JammedIfClosed& seen = *answer.if_closed;
        jammed["if_contacts_close"] = {
            {"verdict", to_string(seen.verdict)}, {"contacts", seen.contacts}, {"within", or_null(seen.within)}};
        out.line("  if contacts close",
                 "{}, of each packing within {} of these coordinates in which the {} contacts all "
                 "close{}; whether there is one is not asked",
                 to_string(seen.verdict), rounded_down(seen.within, 2), seen.contacts,
                 seen.verdict == Verdict::refuted ? " and no other pair touches" : "");
    }
}

} // namespace

std::string cell_words(const Packing& packing) {
    std::string text;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        text += fmt::format("{}{} ({})", a == 0 ? "" : " x ", packing.length(static_cast<int>(a)),
                            packing.cell.periodic[a] ? "periodic" : "walls");
    }
    const std::vector<std::string> names = moving(packing.cell);
    return fmt::format("{}, tilt {}; {}, {} {} is pinned", text, fmt::join(tilts_of(packing), ", "),
                       names.empty()              ? "no period moves"
                       : packing.cell.keeps_shape ? "it keeps its shape"
                                                  : fmt::format("{} move", fmt::join(names, ", ")),
                       grain_word(packing.dimension), packing.cell.pin);
}

Json add_counts(Answer& out, const std::string& title, const StrainCounts& counts) {
    out.line(title, "{:>7} {:>7} {:>7} {:>6} {:>6}", "N_f", "N", "rank", "h", "k");
    for (std::size_t k = 0; k < strains.size(); ++k) {
        const Counting& c = counts[k];
        out.line(fmt::format("  {}", to_string(strains[k])), "{:>7} {:>7} {:>7} {:>6} {:>6}", c.dof_count,
                 c.contact_count, c.rank, marked(c.hyperstaticity, c), marked(c.mechanisms, c));
    }
    return json::counts(counts);
}

void add_cell(Answer& out, const Packing& packing, const CellInspection& cell) {
    const char* const grain = grain_word(cell.dimension);
    Answer in;
    in.item("moves", moving(packing.cell));
    in.item("tilt", packing.dimension == plane ? or_null(packing.lattice(0, 1)) : Json(tilts_of(packing)));
    in.item("all", add_counts(in, fmt::format("all {}s", grain), cell.all));
    in.item("backbone_disks", cell.backbone_disks);
    in.item("backbone", nullptr);
    if (cell.backbone) {
        const auto bulk = contacts_for_bulk_modulus(cell.backbone_disks, cell.dimension);
        const auto all = contacts_for_all_moduli(cell.backbone_disks, cell.dimension);
        in.item("backbone",
                add_counts(in, fmt::format("backbone, {} {}s", cell.backbone_disks, grain), *cell.backbone));
        in.item("contacts_for_bulk_modulus", bulk);
        in.item("contacts_for_all_moduli", all, "contacts needed",
                "{} for a bulk modulus, {} for all moduli (Goodrich et al., by counting); here {}", bulk, all,
                (*cell.backbone)[0].contact_count);
    }
    add_answer(in, "local", cell.local);
    add_answer(in, "collective", cell.collective);
    add_answer(in, "strict", cell.strict);
    out.part("cell", std::move(in));
}

void add_box(Answer& out, const Packing& packing, const BoxInspection& box) {
    const Counting& c = box.counting;
    Answer in;
    in.json = json::counts(c);
    in.item("grains", box.grains, "walls held",
            "N_f = {}, N = {}, h = {}, k = {} of {} {}s that are no rattlers by coordination", c.dof_count,
            c.contact_count, marked(c.hyperstaticity, c), marked(c.mechanisms, c), box.grains,
            grain_word(packing.dimension));
    add_answer(in, "collective", box.collective);
    out.part("box", std::move(in));
}

} // namespace isostat::answers
