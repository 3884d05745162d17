#include <isostat/statics/decisions.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double u = 0x1p-53;

/// A contact that may be opened, with the quantity by which the rule orders it (smallest first).
struct Contender {
    ContactId contact;
    Enclosure force; ///< what must be negative (for a held coordinate: minus the magnitude)
    Enclosure key;   ///< what the rule compares
};

/// Outcome of one attempt on one rung: decided, or the message that says what was not.
template <class T> struct Attempt {
    std::optional<T> decided;
    std::string open_question;
    FailureKind kind = FailureKind::undecided;
};

template <int Dim> std::string name(const Statics<Dim>& statics, ContactId l) {
    return to_string<Dim>(statics.structure().contacts()[l.index()]);
}

template <int Dim> bool is_held(const Statics<Dim>& statics, ContactId l) {
    return statics.structure().contacts()[l.index()].kind == ContactKind::held;
}

/// 2-norm of the mechanism that opens contact l at unit rate (the held and kept others at rest), enclosed.
template <int Dim> Enclosure mechanism_norm(const Statics<Dim>& statics, ContactId l) {
    const sparse::Matrix<double>& h = statics.structure().matrix();
    std::vector<double> v(static_cast<std::size_t>(h.rows), 0.0);
    v[l.index()] = 1;
    statics.factorisation().solve_velocities(v);
    double residual = 0;
    double size = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        double dot = j == l.index() ? -1.0 : 0.0;
        double terms = std::abs(dot);
        for (int e = h.start[j]; e < h.start[j + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            const double term = h.value[s] * v[static_cast<std::size_t>(h.row[s])];
            dot += term;
            terms += std::abs(term);
        }
        const double bound = std::abs(dot) + 12 * u * terms; // at most 4 terms, 5u per entry
        residual += bound * bound;
    }
    for (const double c : v) {
        size += c * c;
    }
    const double value = std::sqrt(size);
    return {value, std::sqrt(residual) * (1 + 1e-10) / statics.inverse().sigma_min + 1e-10 * value};
}

/// f / |v| for the steepest rule.
Enclosure quotient(const Enclosure& f, const Enclosure& norm) {
    const double value = f.value / norm.value;
    const double smallest = norm.value - norm.radius;
    if (!(smallest > 0)) {
        return {value, infinity};
    }
    return {value, (f.radius + std::abs(value) * norm.radius) / smallest * (1 + 8 * u) + 2 * u * std::abs(value)};
}

/// Picks by the rule among contenders that all carry a proved negative force.
template <int Dim>
Attempt<Opening> pick(const Statics<Dim>& statics, std::vector<Contender>& negative, OpeningRule rule,
                      std::uint64_t random_bits) {
    Attempt<Opening> attempt;
    double margin = infinity;
    if (rule == OpeningRule::random) {
        // Ordered by identity, so that the choice does not depend on the order of the contact list.
        std::sort(negative.begin(), negative.end(), [&](const Contender& a, const Contender& b) {
            const auto& contacts = statics.structure().contacts();
            return contacts[a.contact.index()] < contacts[b.contact.index()];
        });
        const Contender& chosen = negative[random_bits % negative.size()];
        attempt.decided = Opening{chosen.contact, false, chosen.force, +1, chosen.force.margin(), statics.rung()};
        return attempt;
    }
    for (Contender& c : negative) {
        c.key = c.force;
        if (rule == OpeningRule::least_negative) {
            c.key.value = -c.key.value;
        } else if (rule == OpeningRule::steepest) {
            c.key = quotient(c.force, mechanism_norm(statics, c.contact));
        }
    }
    const auto best = std::min_element(negative.begin(), negative.end(), [](const Contender& a, const Contender& b) {
        return a.key.value < b.key.value;
    });
    for (const Contender& c : negative) {
        if (c.contact == best->contact) {
            continue;
        }
        const Enclosure difference = c.key - best->key;
        margin = std::min(margin, difference.margin());
        if (!difference.positive()) {
            attempt.kind = FailureKind::tie;
            attempt.open_question = fmt::format(
                "the opening rule cannot order the contacts {} (f = {:.17g}) and {} (f = {:.17g}): the keys differ by "
                "{:.3g}, proved to {:.3g}",
                name(statics, best->contact), best->force.value, name(statics, c.contact), c.force.value,
                difference.value, difference.radius);
            return attempt;
        }
    }
    attempt.decided =
        Opening{best->contact, false, best->force, +1, std::min(margin, best->force.margin()), statics.rung()};
    return attempt;
}

/// One stage of the lexicographic decision: all contacts with `finite` (or without) a finite force.
template <int Dim, class Value>
Attempt<OpeningDecision> stage(const Statics<Dim>& statics, bool finite, Value value, OpeningRule rule,
                               ContactId fresh_hold, std::uint64_t random_bits) {
    Attempt<OpeningDecision> attempt;
    std::vector<Contender> negative;
    double margin = infinity;
    std::optional<Contender> doubtful; // a force whose sign is not proved, the smallest of them
    for (std::size_t index = 0; index < statics.structure().contacts().size(); ++index) {
        const ContactId l(index);
        if (l == fresh_hold || statics.is_structural_zero(l) == finite) {
            continue;
        }
        Enclosure f = value(l);
        if (is_held(statics, l)) {
            f.value = -std::abs(f.value);
        }
        if (f.positive()) {
            margin = std::min(margin, f.margin());
        } else if (f.negative()) {
            negative.push_back({l, f, f});
        } else if (!doubtful || f.value - f.radius < doubtful->force.value - doubtful->force.radius) {
            doubtful = Contender{l, f, f};
        }
    }
    // A doubtful sign matters when no force is negative, when the rule needs the whole list, or when it could be the
    // smallest.
    const bool whole_list = rule != OpeningRule::most_negative;
    const auto smallest =
        std::min_element(negative.begin(), negative.end(),
                         [](const Contender& a, const Contender& b) { return a.force.value < b.force.value; });
    if (doubtful && (negative.empty() || whole_list || !(Enclosure(doubtful->force - smallest->force)).positive())) {
        attempt.open_question =
            fmt::format("the sign of the {}force in contact {} is not decided: {:.3g}, proved to {:.3g}",
                        finite ? "" : "infinitesimal ", name(statics, doubtful->contact), doubtful->force.value,
                        doubtful->force.radius);
        return attempt;
    }
    if (negative.empty()) {
        attempt.decided = OpeningDecision{std::nullopt, margin, statics.rung()};
        return attempt;
    }
    Attempt<Opening> picked = pick(statics, negative, rule, random_bits);
    if (!picked.decided) {
        return {std::nullopt, picked.open_question, picked.kind};
    }
    Opening opening = *picked.decided;
    opening.infinitesimal = !finite;
    if (is_held(statics, opening.contact)) {
        opening.force = value(opening.contact);
        opening.direction = opening.force.value < 0 ? +1 : -1;
    }
    attempt.decided = OpeningDecision{opening, opening.margin, statics.rung()};
    return attempt;
}

template <int Dim>
Attempt<OpeningDecision> attempt_opening(const Statics<Dim>& statics, double sigma, OpeningRule rule,
                                         ContactId fresh_hold, std::uint64_t random_bits) {
    auto finite = stage(
        statics, true, [&](ContactId l) { return statics.force(l, sigma); }, rule, fresh_hold, random_bits);
    if (!finite.decided || finite.decided->opening) {
        return finite;
    }
    auto infinitesimal = stage(
        statics, false, [&](ContactId l) { return statics.infinitesimal(l); }, rule, fresh_hold, random_bits);
    if (infinitesimal.decided) {
        infinitesimal.decided->margin = std::min(infinitesimal.decided->margin, finite.decided->margin);
    }
    return infinitesimal;
}

/// Contacts whose finite forces vanish together with that of `opens` for every choice of the coefficients: with the
/// column of `opens` replaced by the unit column of the loaded wall, they are structural zeros.
template <int Dim> std::vector<ContactId> tie_class(const Statics<Dim>& statics, ContactId opens) {
    const sparse::Matrix<double>& h = statics.structure().matrix();
    std::vector<int> start{0};
    std::vector<int> row;
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        if (j == opens.index()) {
            row.push_back(statics.loaded_wall_row());
        } else {
            row.insert(row.end(), h.row.begin() + h.start[j], h.row.begin() + h.start[j + 1]);
        }
        start.push_back(static_cast<int>(row.size()));
    }
    std::vector<ContactId> members{opens};
    const std::vector<int> matched = sparse::perfect_matching(h.rows, start, row);
    if (matched.empty()) {
        return members; // cannot happen when the slope of `opens` is not zero; then no tie is claimed
    }
    const auto nonzero = sparse::structural_nonzeros(start, row, matched, statics.loaded_rows());
    for (std::size_t j = 0; j < nonzero.size(); ++j) {
        const ContactId l(j);
        if (l != opens && nonzero[j] == 0 && !statics.is_structural_zero(l)) {
            members.push_back(l);
        }
    }
    return members;
}

template <int Dim> Attempt<LoadLimit> attempt_limit(const Statics<Dim>& statics, double sigma, int direction) {
    Attempt<LoadLimit> attempt;
    const std::size_t count = statics.structure().contacts().size();
    ContactId first;
    double smallest = infinity;
    for (std::size_t index = 0; index < count; ++index) {
        const ContactId l(index);
        if (is_held(statics, l) || statics.slope_is_zero(l)) {
            continue;
        }
        const double rate = direction * statics.slope(l).value;
        const double distance = rate < 0 ? statics.force(l, sigma).value / -rate : infinity;
        if (distance < smallest) {
            smallest = distance;
            first = l;
        }
    }
    if (!first.valid()) {
        for (std::size_t index = 0; index < count; ++index) {
            const ContactId l(index);
            if (!is_held(statics, l) && !statics.slope_is_zero(l)) {
                Enclosure rate = statics.slope(l);
                rate.value *= direction;
                if (!rate.positive()) {
                    attempt.open_question = fmt::format(
                        "the sign of the slope of the force in contact {} is not decided: {:.3g}, proved to {:.3g}",
                        name(statics, l), rate.value, rate.radius);
                    return attempt;
                }
            }
        }
        attempt.decided = LoadLimit{true, direction * infinity, 0, ContactId(), {}, infinity, statics.rung()};
        return attempt;
    }
    const Enclosure slope = statics.slope(first);
    if (!slope.decided()) {
        attempt.open_question =
            fmt::format("the slope of the force in contact {} is not decided: {:.3g}, proved to {:.3g}",
                        name(statics, first), slope.value, slope.radius);
        return attempt;
    }
    LoadLimit limit;
    limit.stress = sigma + direction * smallest;
    limit.rung = statics.rung();
    {
        const Enclosure at_limit = statics.force(first, limit.stress);
        limit.stress_error =
            (std::abs(at_limit.value) + at_limit.radius) / (std::abs(slope.value) - slope.radius) * (1 + 8 * u);
    }
    limit.margin = slope.margin();
    limit.tie_class = tie_class(statics, first);
    std::vector<unsigned char> in_class(count, 0);
    for (const ContactId l : limit.tie_class) {
        in_class[l.index()] = 1;
    }
    // Everything else is still positive at the limit, hence on the whole interval (forces are affine).
    for (std::size_t index = 0; index < count; ++index) {
        const ContactId l(index);
        if (in_class[index] != 0 || is_held(statics, l) || statics.is_structural_zero(l)) {
            continue;
        }
        Enclosure f = statics.force(l, limit.stress);
        f.radius += std::abs(statics.slope(l).value) * limit.stress_error * (1 + 8 * u) +
                    statics.slope(l).radius * limit.stress_error;
        limit.margin = std::min(limit.margin, f.margin());
        if (!f.positive()) {
            attempt.kind = FailureKind::tie;
            attempt.open_question =
                fmt::format("the forces in the contacts {} and {} vanish at loads that are not ordered: at sigma = "
                            "{:.17g} the second is "
                            "{:.3g}, proved to {:.3g}",
                            name(statics, first), name(statics, l), limit.stress, f.value, f.radius);
            return attempt;
        }
    }
    // Within the class: the infinitesimal loads decide which force reaches zero first.
    ContactId chosen;
    Enclosure best{infinity, 0};
    for (int pass = 0; pass < 2; ++pass) {
        for (const ContactId l : limit.tie_class) {
            const Enclosure b = statics.slope(l);
            if (is_held(statics, l)) {
                continue;
            }
            Enclosure magnitude{std::abs(b.value), b.radius};
            const Enclosure key =
                limit.tie_class.size() == 1 ? Enclosure{0, 0} : quotient(statics.infinitesimal(l), magnitude);
            if (pass == 0) {
                if (!chosen.valid() || key.value < best.value) {
                    best = key;
                    chosen = l;
                }
            } else if (l != chosen) {
                const Enclosure difference = key - best;
                limit.margin = std::min(limit.margin, difference.margin());
                if (!difference.positive()) {
                    attempt.kind = FailureKind::tie;
                    attempt.open_question =
                        fmt::format("the infinitesimal loads do not order the contacts {} and {} of a structural tie "
                                    "class of {}: the keys differ by {:.3g}, proved to {:.3g}",
                                    name(statics, chosen), name(statics, l), limit.tie_class.size(), difference.value,
                                    difference.radius);
                    return attempt;
                }
            }
        }
    }
    limit.opens = chosen;
    attempt.decided = limit;
    return attempt;
}

/// Tries in double, then in double-double; what is still open then is the failure.
template <int Dim, class Try> auto climb_until_decided(Statics<Dim>& statics, Try attempt_once) {
    auto attempt = attempt_once();
    while (!attempt.decided && statics.climb()) {
        attempt = attempt_once();
    }
    return attempt;
}

} // namespace

template <int Dim>
Result<OpeningDecision> decide_opening(Statics<Dim>& statics, double sigma, OpeningRule rule, ContactId fresh_hold,
                                       std::uint64_t random_bits) {
    auto attempt =
        climb_until_decided(statics, [&] { return attempt_opening(statics, sigma, rule, fresh_hold, random_bits); });
    if (!attempt.decided) {
        return Failure{attempt.kind, attempt.open_question};
    }
    return *attempt.decided;
}

template <int Dim> Result<LoadLimit> find_limit(Statics<Dim>& statics, double sigma, int direction) {
    auto attempt = climb_until_decided(statics, [&] { return attempt_limit(statics, sigma, direction); });
    if (!attempt.decided) {
        return Failure{attempt.kind, attempt.open_question};
    }
    return *attempt.decided;
}

template Result<OpeningDecision> decide_opening<2>(Statics<2>&, double, OpeningRule, ContactId, std::uint64_t);
template Result<LoadLimit> find_limit<2>(Statics<2>&, double, int);

} // namespace isostat
