#include "trajectory/limit_attempts.hpp"

#include "contact/words.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

using roundoff::infinity;

template <int Dim> Result<Reached<Dim>> LimitAttempts<Dim>::begin(Attempt<Dim>& attempt) {
    RunCounters& counters = recorder_.counters;
    const RunOptions& options = recorder_.options;
    const RunCounters before = counters;
    const LimitLoad<Dim> nearest = attempt.at;
    auto reached = follow_(attempt);
    if (!attempt.in_vain(reached) || at_first_order(options.ties)) {
        return reached;
    }
    if (const auto stress = beyond()) {
        counters = before;
        attempt.at.set_stress(*stress);
        reached = follow_(attempt);
    }
    if (attempt.in_vain(reached) && options.ties == TiePolicy::by_class) {
        if (auto another = open_another(attempt, {nearest, attempt.at}, before)) {
            return std::move(*another);
        }
    }
    if (attempt.in_vain(reached)) {
        return offering_class(reached.failure(), attempt.opening.contact);
    }
    return reached;
}

/// The first double beyond the limit; none: it is not known that well. The nearest double may lie before the limit: the
/// force that opens is then still positive, by roundings, and on a way as short as those the potential grows.
template <int Dim> std::optional<double> LimitAttempts<Dim>::beyond() {
    auto found = find_limit<Dim>(statics_, sigma_, direction_, nullptr);
    const auto known = [&] {
        const double size = std::abs(found.value().stress);
        return found.value().stress_error <= std::nextafter(size, infinity) - size;
    };
    while (found.ok() && !known() && statics_.climb()) {
        found = find_limit<Dim>(statics_, sigma_, direction_, nullptr);
    }
    if (!found.ok() || !known()) {
        return std::nullopt;
    }
    return std::nextafter(found.value().stress + direction_ * found.value().stress_error, direction_ * infinity);
}

/// With another force that vanishes at the same load; none: all were in vain, and counters are as they were.
template <int Dim>
std::optional<Result<Reached<Dim>>> LimitAttempts<Dim>::open_another(Attempt<Dim>& attempt,
                                                                     const std::array<LimitLoad<Dim>, 2>& loads,
                                                                     const RunCounters& before) {
    RunCounters& counters = recorder_.counters;
    const RunCounters after = counters;
    for (const TieDecision& choice : others_of_class(statics_, attempt.opening.contact)) {
        const auto& contacts = statics_.structure().contacts();
        const auto chosen = std::find(contacts.begin(), contacts.end(), choice.chosen) - contacts.begin();
        for (const LimitLoad<Dim>& at : loads) {
            counters = before;
            Attempt<Dim> other{attempt.opening, attempt.kind, at, {choice}};
            other.opening.contact = ContactId(static_cast<std::size_t>(chosen));
            auto reached = follow_(other);
            if (!other.in_vain(reached)) {
                attempt = std::move(other);
                return reached;
            }
        }
    }
    counters = after;
    return std::nullopt;
}

/// What a run that chooses nothing says where another policy would look further.
template <int Dim> Failure LimitAttempts<Dim>::offering_class(const Failure& failure, ContactId first) const {
    const RunOptions& options = recorder_.options;
    const bool may = options.ties == TiePolicy::stop && !others_of_class(statics_, first).empty();
    return may ? failed(failure.kind, "{}; other forces vanish with it: ties = \"class\" in [run] may open one of them",
                        failure)
               : failure;
}

template class LimitAttempts<2>;

} // namespace isostat
