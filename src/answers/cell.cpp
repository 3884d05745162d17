#include "answers/state.hpp"
#include "core/decimal.hpp"
#include "io/text.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace isostat::answers {

using json::Json;
using json::or_null;
using text::say;

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

void print_answer(std::string& out, const char* title, const JammingAnswer& answer) {
    say(out, "{:<24} {}: {}\n", title, to_string(answer.verdict), answer.reason);
    if (answer.verdict == Verdict::undecided && answer.if_closed) {
        const JammedIfClosed& seen = *answer.if_closed;
        say(out,
            "  if contacts close      {}, of each packing within {} of these coordinates in which the {} contacts all "
            "close{}; whether there is one is not asked\n",
            to_string(seen.verdict), rounded_down(seen.within, 2), seen.contacts,
            seen.verdict == Verdict::refuted ? " and no other pair touches" : "");
    }
}

Json jammed_json(const JammingAnswer& answer) {
    Json out{{"verdict", to_string(answer.verdict)}, {"reason", answer.reason}};
    if (answer.verdict == Verdict::undecided && answer.if_closed) {
        out["if_contacts_close"] = {{"verdict", to_string(answer.if_closed->verdict)},
                                    {"contacts", answer.if_closed->contacts},
                                    {"within", or_null(answer.if_closed->within)}};
    }
    return out;
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

void print_counts(std::string& out, const std::string& title, const StrainCounts& counts) {
    say(out, "{:<24} {:>7} {:>7} {:>7} {:>6} {:>6}\n", title, "N_f", "N", "rank", "h", "k");
    for (std::size_t k = 0; k < strains.size(); ++k) {
        const Counting& c = counts[k];
        say(out, "  {:<22} {:>7} {:>7} {:>7} {:>6} {:>6}\n", to_string(strains[k]), c.dof_count, c.contact_count,
            c.rank, marked(c.hyperstaticity, c), marked(c.mechanisms, c));
    }
}

void print_cell(std::string& out, const CellInspection& cell) {
    const char* const grain = grain_word(cell.dimension);
    print_counts(out, fmt::format("all {}s", grain), cell.all);
    if (cell.backbone) {
        print_counts(out, fmt::format("backbone, {} {}s", cell.backbone_disks, grain), *cell.backbone);
        say(out, "{:<24} {} for a bulk modulus, {} for all moduli (Goodrich et al., by counting); here {}\n",
            "contacts needed", contacts_for_bulk_modulus(cell.backbone_disks, cell.dimension),
            contacts_for_all_moduli(cell.backbone_disks, cell.dimension), (*cell.backbone)[0].contact_count);
    }
    print_answer(out, "jammed locally", cell.local);
    print_answer(out, "jammed collectively", cell.collective);
    print_answer(out, "jammed strictly", cell.strict);
}

void print_box(std::string& out, const Packing& packing, const BoxInspection& box) {
    const Counting& c = box.counting;
    say(out, "{:<24} N_f = {}, N = {}, h = {}, k = {} of {} {}s that are no rattlers by coordination\n", "walls held",
        c.dof_count, c.contact_count, marked(c.hyperstaticity, c), marked(c.mechanisms, c), box.grains,
        grain_word(packing.dimension));
    print_answer(out, "jammed collectively", box.collective);
}

Json box_json(const BoxInspection& box) {
    Json out{{"grains", box.grains}};
    out.update(json::counts(box.counting));
    out["jammed"]["collective"] = jammed_json(box.collective);
    return out;
}

Json cell_json(const Packing& packing, const CellInspection& cell) {
    Json out;
    out["moves"] = moving(packing.cell);
    if (packing.dimension == plane) {
        out["tilt"] = or_null(packing.lattice(0, 1));
    } else {
        out["tilt"] = tilts_of(packing);
    }
    out["all"] = json::counts(cell.all);
    out["backbone_disks"] = cell.backbone_disks;
    out["backbone"] = cell.backbone ? json::counts(*cell.backbone) : Json();
    for (const auto& [name, answer] : {std::pair("local", &cell.local), std::pair("collective", &cell.collective),
                                       std::pair("strict", &cell.strict)}) {
        out["jammed"][name] = jammed_json(*answer);
    }
    if (cell.backbone) {
        out["contacts_for_bulk_modulus"] = contacts_for_bulk_modulus(cell.backbone_disks, cell.dimension);
        out["contacts_for_all_moduli"] = contacts_for_all_moduli(cell.backbone_disks, cell.dimension);
    }
    return out;
}

} // namespace isostat::answers
