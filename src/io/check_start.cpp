#include <isostat/contact/candidates.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat {

template <int Dim> void check_start(const State<Dim>& state, const std::string& source) {
    const auto bad = [&](const std::string& what) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {}", source, what));
    };
    validate(state.packing, source);
    // Far above the rounding of a vertex (1e-15) and far below any gap that matters to a user's eye.
    const double visible = 1e-6 * state.packing.min_radius();
    const Admissibility admissible = certify_admissible(state.packing, visible);
    if (admissible.verdict == Verdict::refuted) {
        bad(fmt::format("grains overlap: the gap of {} is {:.6g}: expected every gap >= 0",
                        to_string<Dim>(admissible.worst), admissible.worst_gap));
    }
    for (const Contact& contact : state.contacts) {
        const double opening = gap(state.packing, contact);
        if (std::abs(opening) > visible) {
            bad(fmt::format("the gap of the listed contact {} is {:.6g}: expected 0", to_string<Dim>(contact),
                            opening));
        }
    }
    const Counting count = count_contacts(state.packing, state.contacts);
    if (count.hyperstaticity != 0 || count.mechanisms != 0) {
        bad(fmt::format("N_f = {} degrees of freedom, N = {} contacts, rank {}: h = {}, k = {}: a trajectory starts "
                        "from an isostatic "
                        "structure, N = N_f = rank (h = k = 0)",
                        count.dof_count, count.contact_count, count.rank, count.hyperstaticity, count.mechanisms));
    }
}

template void check_start<2>(const State<2>&, const std::string&);

} // namespace isostat
