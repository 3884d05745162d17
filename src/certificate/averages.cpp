#include "certificate/averages.hpp"

#include "contact/separation.hpp"
#include "packing/bodies.hpp"

#include <algorithm>

namespace isostat {

namespace {

double mean_of_ends(const Interval& force) {
    return 0.5 * force.lower + 0.5 * force.upper; // exact: a half
}

/// Held coordinates carry no force between grains.
bool carries(const State& state, const Certification& truth, std::size_t l) {
    return truth.structural_zero[l] == 0 && state.contacts[l].is_unilateral();
}

} // namespace

Coordination coordination(const State& state, const Certification& truth, int rattlers) {
    Coordination ends;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const int of_contact = !state.contacts[l].is_unilateral() ? 0 : state.contacts[l].of_disks() ? 2 : 1;
        ends.all += of_contact;
        ends.carrying += carries(state, truth, l) ? of_contact : 0;
    }
    const int grains = Bodies(state.packing).count();
    return {ends.all / std::max(1, grains), ends.carrying / std::max(1, grains - rattlers)};
}

std::vector<int> contacts_of_grains(const State& state) {
    std::vector<int> count(state.packing.radius.size());
    for (const Contact& contact : state.contacts) {
        if (!contact.is_unilateral()) {
            continue;
        }
        ++count[static_cast<std::size_t>(contact.i)];
        if (contact.of_disks()) {
            ++count[static_cast<std::size_t>(contact.j)];
        }
    }
    return count;
}

ForceAverages force_averages(const State& state, const Certification& truth) {
    ForceAverages sum;
    const Packing& packing = state.packing;
    double volume = 1;
    for (int a = 0; a < packing.dimension; ++a) {
        volume *= packing.length(a);
    }
    int contacts = 0;
    int pairs = 0;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& contact = state.contacts[l];
        const bool bar = contact.kind == ContactKind::bar; // hands on what acts on one member to the others
        if (!carries(state, truth, l) && !bar) {
            continue;
        }
        const bool pair = contact.kind == ContactKind::disk_disk;
        const double force = mean_of_ends(truth.finite[l]);
        const double length = zero_distance(packing, contact);
        const PerAxis<double> n = outward(state, contact);
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            for (std::size_t b = 0; b < packing.axes(); ++b) {
                sum.stress[a][b] += force * n[a] * n[b] * length / volume;
                sum.fabric[a][b] += pair ? n[a] * n[b] : 0;
            }
            sum.pressure += force * n[a] * n[a] * length / volume / packing.dimension;
        }
        sum.mean_force += bar ? 0 : force;
        contacts += bar ? 0 : 1;
        pairs += pair ? 1 : 0;
    }
    for (PerAxis<double>& row : sum.fabric) {
        std::ranges::transform(row, row.begin(), [pairs](double x) { return x / std::max(1, pairs); });
    }
    sum.mean_force /= std::max(1, contacts);
    return sum;
}

std::vector<std::pair<double, double>> force_distribution(const State& state, const Certification& truth) {
    constexpr double width = 0.25; // choice: width of a bin of P(f), which no proof reads
    std::vector<double> forces;
    double sum = 0;
    for (std::size_t l = 0; l < truth.finite.size(); ++l) {
        if (carries(state, truth, l)) {
            forces.push_back(mean_of_ends(truth.finite[l]));
            sum += forces.back();
        }
    }
    const double mean = sum / static_cast<double>(std::max<std::size_t>(1, forces.size()));
    if (!(mean > 0)) {
        return {};
    }
    const double largest = *std::ranges::max_element(forces) / mean;
    std::vector<std::pair<double, double>> bins(static_cast<std::size_t>(largest / width) + 1);
    for (std::size_t k = 0; k < bins.size(); ++k) {
        bins[k].first = (static_cast<double>(k) + 0.5) * width; // exact: a half
    }
    for (const double force : forces) { // a negative force, of no equilibrium, is in the first bin
        const auto k = static_cast<std::size_t>(std::max(0.0, force / mean / width));
        bins[std::min(k, bins.size() - 1)].second += 1 / (width * static_cast<double>(forces.size()));
    }
    return bins;
}

} // namespace isostat
