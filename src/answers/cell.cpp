#include "answers/state.hpp"
#include "core/decimal.hpp"
#include "io/state_json.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace isostat::answers {

namespace {

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
    const auto names = json::cell_json(packing)["moves"].get<std::vector<std::string>>();
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

namespace {

/// Counts with the strains of a cell, and whether it is jammed.
void add_strains(Answer& in, const CellInspection& cell) {
    const char* const grain = grain_word(cell.dimension);
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
}

} // namespace

void add_cell(Answer& out, const Packing& packing, const CellInspection* cell) {
    Answer in{.json = json::cell_json(packing)};
    if (packing.dimension == plane) {
        in.item("tilt", in.json["tilt"][0]);
    }
    if (cell != nullptr) {
        add_strains(in, *cell);
    }
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
