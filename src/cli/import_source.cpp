#include "cli/import_source.hpp"

#include "cli/common.hpp"
#include "cli/import_contacts.hpp"
#include "contact/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/inspection.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/io/state_file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace isostat::cli {

namespace {

std::array<double, 2> stresses_of(const ImportArguments& a) {
    if (a.stress.empty()) {
        return {1, 1};
    }
    const std::vector<std::string> words = parse_list(a.stress);
    std::array<double, 2> stress{};
    bool good = words.size() == 2;
    for (std::size_t k = 0; good && k < 2; ++k) {
        const char* const end =
            words[k].data() + words[k].size(); // NOLINT(cppcoreguidelines-pro-bounds-pointer-arithmetic)
        const auto [stop, error] = std::from_chars(words[k].data(), end, stress[k]);
        good = error == std::errc() && stop == end && stress[k] > 0 && std::isfinite(stress[k]);
    }
    if (!good) {
        throw Error(ErrorKind::usage, fmt::format("--stress is '{}': expected S1,S2, two positive numbers", a.stress));
    }
    return stress;
}

/// Every wall near a disk, no overlap deep: else the file is no packing of nearly rigid disks in these walls.
void check_nearness(const std::string& file, const Packing<2>& packing) {
    const double near = nearly_touching * packing.min_radius();
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int axis = 0; axis < 2; ++axis) {
            double nearest = HUGE_VAL;
            for (int i = 0; i < packing.disk_count(); ++i) {
                nearest = std::min(nearest, gap<2>(packing, {kind, i, axis}));
            }
            if (nearest > near) {
                const std::string name = to_string<2>({kind, 0, axis}).substr(2);
                refuse(file,
                       fmt::format("no disk is near the {} wall, the nearest gap is {:.3g}: expected the "
                                   "positions of the walls, --box XLO:XHI,YLO:YHI (bounds of a file often are not "
                                   "those)",
                                   name, nearest));
            }
        }
    }
    const double deepest = crafted::plateau(packing, {near}).deepest_overlap;
    if (deepest < -near) {
        refuse(file, fmt::format("two grains overlap by {:.3g}: expected at most {:.3g}, {} of the smallest radius",
                                 -deepest, near, nearly_touching));
    }
}

} // namespace

void refuse(const std::string& file, const std::string& what) {
    throw Error(ErrorKind::bad_input, file + ": " + what);
}

void keep_load(ImportArguments& a) {
    const State<2> state = read_state<2>(a.file).state;
    if (!state.load.disk_force.empty() || state.load.loaded_axis != 1) {
        refuse(a.file, "has forces on disks or another loaded axis than 1: expected a load on the walls alone");
    }
    if (a.stress.empty()) {
        a.stress = fmt::format("{},{}", state.load.stress[0], state.load.stress[1]);
    }
    if (a.load.empty()) {
        a.load = state.load.kind == LoadKind::nominal ? "nominal" : "true";
    }
}

Result<Imported> from_foreign(const ImportArguments& a, ReadPacking& file) {
    const std::array<double, 2> stress = stresses_of(a);
    check_nearness(a.file, file.packing);
    const auto wanted = wanted_contacts(a, file);
    if (!wanted.ok()) {
        return wanted.failure();
    }
    Imported out;
    out.from = file.packing.q;
    file.packing.radius = with_jitter(file.packing.radius, a.jitter, a.seed);
    PreparationOptions options;
    options.seed = a.seed;
    options.stress = stress[0];
    options.ratio = stress[1] / stress[0];
    options.load = a.load == "true" ? LoadKind::true_stress : LoadKind::nominal;
    PreparationReport<2> report;
    auto vertex = find_vertex<2>(file.packing, options, report);
    if (!vertex.ok() && !report.candidate) {
        return vertex.failure();
    }
    out.state = vertex.ok() ? std::move(vertex.value()) : *report.candidate;
    out.truth = isostat::certify(out.state);
    auto words = compared(wanted.value(), carrying(out.state, out.truth));
    if (!words.ok()) {
        return words.failure();
    }
    out.contacts = words.value();
    return out;
}

Result<Imported> from_crafted(const ImportArguments& a, const std::string& text) {
    const crafted::PackingFile file = crafted::parse_packing(text, a.file);
    const auto inspection = crafted::inspect(file.packing);
    if (!inspection.ok()) {
        return inspection.failure();
    }
    const crafted::Inspection& exact = inspection.value();
    if (exact.hyperstaticity != 0 || exact.mechanisms != 0) {
        return isostat::failed(exact.rank_exact == Verdict::proved ? FailureKind::not_isostatic
                                                                   : FailureKind::undecided,
                               "h = {}, k = {}: expected an isostatic packing, whose contacts determine it",
                               exact.hyperstaticity, exact.mechanisms);
    }
    Imported out;
    State<2>& state = out.state;
    state.packing = crafted::approximate(file.packing);
    state.contacts = exact.contacts;
    state.load.stress = stresses_of(a);
    state.load.kind = a.load == "true" ? LoadKind::true_stress : LoadKind::nominal;
    for (std::size_t b = 0; b < 2; ++b) {
        state.load.reference_length[b] = state.packing.length(static_cast<int>(b));
    }
    if (file.packing.load) {
        for (std::size_t b = 0; b < 2; ++b) {
            const double length = state.load.reference_length[1 - b];
            state.load.stress[b] = length > 0 ? file.packing.load->wall[b].to_double() / length : 0;
        }
        for (const exact::Number& force : file.packing.load->disk) {
            state.load.disk_force.push_back(force.to_double());
        }
    }
    out.from = state.packing.q;
    out.truth = isostat::certify(state);
    out.contacts = "those of the crafted packing, exactly";
    return out;
}

} // namespace isostat::cli
