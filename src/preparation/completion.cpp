#include "core/dot.hpp"
#include "preparation/clique_matrix.hpp"
#include "preparation/programme_rows.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace isostat::preparation {

namespace {

/// More contacts than this are missing only where the programme is far from its optimum.
constexpr std::size_t most_missing = 20;
/// Added to the squares of the singular values; far below those of packings and far above rounding.
constexpr double shift = 1e-13;
constexpr int inverse_iterations = 6;
/// Approach of a pair, per displacement, below which it counts as zero, being rounding of the mechanism.
constexpr double no_approach = 1e-9;

/// A velocity that keeps all gaps of the rows constant, as far as inverse iteration tells.
std::optional<std::vector<double>> mechanism(std::size_t columns, const std::vector<int>& start,
                                             const std::vector<int>& column, const std::vector<double>& value) {
    CliqueMatrix matrix(columns, start, column);
    if (!matrix.factorise([&](std::size_t, std::size_t p, std::size_t r) { return value[p] * value[r]; },
                          std::vector<double>(columns, shift))) {
        return std::nullopt;
    }
    std::vector<double> x(columns);
    for (std::size_t k = 0; k < columns; ++k) {
        x[k] = k % 3 == 0 ? 1.0 : -0.5 - static_cast<double>(k % 7);
    }
    for (int i = 0; i < inverse_iterations; ++i) {
        matrix.solve(x);
        for (const double size = largest(x); double& c : x) {
            c /= size;
        }
    }
    return x;
}

} // namespace

bool ContactProgramme::complete(Packing& packing, double eps, std::vector<Contact>& contacts) const {
    const Rows none(packing);
    const std::size_t wanted = none.columns();
    if (contacts.size() + most_missing < wanted) {
        return false;
    }
    while (contacts.size() < wanted) {
        Rows closed(packing);
        Rows open(packing);
        for (const Contact& contact : row_contact_) {
            const bool listed = std::ranges::binary_search(contacts, contact);
            (listed ? closed : open).add(packing, contact);
        }
        auto velocity = mechanism(wanted, closed.starts(), closed.column, closed.value);
        if (!velocity) {
            return false;
        }
        const std::vector<double> cost = boxed(packing, closed, eps).cost;
        double rise = 0;
        for (std::size_t k = 0; k < wanted; ++k) {
            rise += cost[k] * (*velocity)[k];
        }
        std::vector<double> approach(open.contact.size(), 0.0);
        for (std::size_t e = 0; e < open.row.size(); ++e) {
            const double rate = open.value[e] * (*velocity)[static_cast<std::size_t>(open.column[e])];
            approach[static_cast<std::size_t>(open.row[e])] += rise > 0 ? rate : -rate;
        }
        double time = std::numeric_limits<double>::infinity();
        std::size_t first = 0;
        for (std::size_t l = 0; l < approach.size(); ++l) {
            if (approach[l] > no_approach && std::max(open.gap[l], 0.0) / approach[l] < time) {
                time = std::max(open.gap[l], 0.0) / approach[l];
                first = l;
            }
        }
        if (!(time < trust_)) {
            return false;
        }
        for (std::size_t k = 0; k < wanted; ++k) {
            const std::size_t at = none.dofs.coordinate_of(k);
            packing.q[at] += (rise > 0 ? -time : time) * (*velocity)[k];
        }
        contacts.insert(std::ranges::upper_bound(contacts, open.contact[first]), open.contact[first]);
    }
    return contacts.size() == wanted;
}

} // namespace isostat::preparation
