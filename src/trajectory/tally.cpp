#include <isostat/trajectory/records.hpp>

#include <cmath>

namespace isostat {

namespace {

void lower(double& smallest, double margin) {
    if (std::isfinite(margin) && (smallest == 0 || margin < smallest)) {
        smallest = margin;
    }
}

} // namespace

void Tally::count(DecisionKind kind, double margin, Rung rung) {
    const auto k = static_cast<std::size_t>(kind);
    if (rung == Rung::none) {
        ++undecided;
        return;
    }
    ++by_kind[k][static_cast<std::size_t>(rung)];
    switch (rung) {
    case Rung::combinatorial: ++combinatorial; break;
    case Rung::double_bound: ++double_bound; break;
    case Rung::double_double: ++double_double; break;
    case Rung::multiprecision: ++multiprecision; break;
    case Rung::exact: ++exact; break;
    case Rung::none: break;
    }
    lower(smallest_margin, margin);
    lower(smallest_margin_of[k], margin);
}

} // namespace isostat
