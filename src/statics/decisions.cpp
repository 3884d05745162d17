#include "statics/straight_strut.hpp"

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
    Enclosure force;       ///< what must be negative (for a held coordinate: minus the magnitude)
    Enclosure key;         ///< what the rule compares
    double margin;         ///< with which the sign of `force` is proved
    double multiplier = 0; ///< of a held coordinate, with its sign
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
    const double away = statics.normal_uncertainty();
    const double sigma = statics.inverse().sigma_min - away;
    const double error = (std::sqrt(residual) + away * value) * (1 + 1e-10);
    return {value, sigma > 0 ? error / sigma * (1 + 1e-10) + 1e-10 * value : infinity};
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

/// "proved to 256 bits" or "exactly".
std::string reach(const Order& order) {
    return order.decided ? "they are exactly equal" : fmt::format("they agree to {} bits", order.bits);
}

/// Difference of two enclosures where that decides, the ladder where it does not.
template <int Dim>
Order order_of(Statics<Dim>& statics, const Enclosure& difference, const ForceExpression& a, const ForceExpression& b) {
    if (difference.decided()) {
        return {true, difference.positive() ? 1 : -1, difference.margin(), statics.rung(), statics.bits()};
    }
    return statics.compare(a, b);
}

/// First-order term of what the rule compares, for a contender of the finite stage.
template <int Dim>
Enclosure first_order_key(PerturbedStatics<Dim>& perturbed, const Statics<Dim>& statics, const Contender& contender,
                          OpeningRule rule) {
    Enclosure f1 = perturbed.force(contender.contact);
    // A held coordinate competes with -|m|: its derivative is -sign(m) m1, and the force of the contender is -|m|.
    const bool flipped = is_held(statics, contender.contact) && contender.multiplier > 0;
    if (flipped != (rule == OpeningRule::least_negative)) {
        f1.value = -f1.value;
    }
    return f1;
}

/// What a comparison of first-order terms needs to be called one: said in messages.
std::string shown(const Enclosure& e) {
    return fmt::format("{:.6g} +- {:.3g}", e.value, e.radius);
}

/// Picks by the rule among contenders that all carry a proved negative force. At a fresh hold the contacts of a
/// straight strut carry one force (S4): the infinitesimal loads order them, not the digits to which the turn was
/// located.
template <int Dim, class Expression>
Result<Opening> pick(Statics<Dim>& statics, std::vector<Contender>& negative, Expression expression, OpeningRule rule,
                     std::uint64_t random_bits, const Turn<Dim>* turn = nullptr,
                     PerturbedStatics<Dim>* perturbed = nullptr) {
    if (rule == OpeningRule::random) {
        // Ordered by identity, so that the choice does not depend on the order of the contact list.
        std::sort(negative.begin(), negative.end(), [&](const Contender& a, const Contender& b) {
            const auto& contacts = statics.structure().contacts();
            return contacts[a.contact.index()] < contacts[b.contact.index()];
        });
        const Contender& chosen = negative[random_bits % negative.size()];
        return Opening{chosen.contact, false, chosen.force, +1, chosen.margin, statics.rung()};
    }
    for (Contender& c : negative) {
        c.key = c.force;
        if (rule == OpeningRule::least_negative) {
            c.key.value = -c.key.value;
        } else if (rule == OpeningRule::steepest) {
            c.key = quotient(c.force, mechanism_norm(statics, c.contact));
        }
    }
    const auto key = [&](const Contender& c) {
        ForceExpression e = expression(c.contact);
        if (rule == OpeningRule::steepest) {
            e.divisor = ForceExpression::Divisor::mechanism;
        }
        return e;
    };
    const bool by_force = rule == OpeningRule::most_negative || rule == OpeningRule::least_negative;
    std::size_t best = 0;
    for (std::size_t k = 1; k < negative.size(); ++k) {
        if (negative[k].key.value < negative[best].key.value) {
            best = k;
        }
    }
    // The enclosures may have put the wrong one first: whoever is proved smaller takes its place, which happens at most
    // once per contender.
    for (std::size_t restart = 0; restart <= negative.size(); ++restart) {
        double margin = infinity;
        Rung rung = statics.rung();
        std::string tied;
        std::vector<TieDecision> settled;
        bool strut = false;
        std::optional<std::size_t> better;
        const auto mates = turn != nullptr && by_force ? turn->mates(negative[best].contact) : std::vector<StrutMate>();
        for (std::size_t k = 0; k < negative.size() && !better; ++k) {
            if (k == best) {
                continue;
            }
            const auto mate = std::find_if(mates.begin(), mates.end(),
                                           [&](const StrutMate& m) { return m.contact == negative[k].contact; });
            if (mate != mates.end()) {
                strut = true;
                const Enclosure& excess = mate->excess;
                if (!excess.decided()) {
                    tied +=
                        fmt::format("; {} (f = {:.17g}): the two ends of a straight strut, which the infinitesimal "
                                    "loads do not order: {:.3g}, known to {:.3g}",
                                    name(statics, mate->contact), negative[k].force.value, excess.value, excess.radius);
                } else if (excess.positive() == (rule == OpeningRule::least_negative)) {
                    better = k;
                } else {
                    margin = std::min(margin, excess.margin());
                }
                continue;
            }
            Order order =
                order_of(statics, negative[k].key - negative[best].key, key(negative[k]), key(negative[best]));
            if (rule == OpeningRule::least_negative && !(negative[k].key - negative[best].key).decided()) {
                order.sign = -order.sign; // expressions are forces, keys their opposites
            }
            if ((!order.decided || order.sign == 0) && perturbed != nullptr && rule != OpeningRule::steepest &&
                is_tie(order, perturbed->size())) {
                const Enclosure mine = first_order_key(*perturbed, statics, negative[best], rule);
                const Enclosure other = first_order_key(*perturbed, statics, negative[k], rule);
                const Enclosure difference = other - mine;
                if (!difference.decided()) {
                    return Failure{FailureKind::undecided,
                                   fmt::format("tied at first order too: the opening rule cannot order {} and {} ({}), "
                                               "and the first-order terms of what it compares are {} and {}",
                                               name(statics, negative[best].contact),
                                               name(statics, negative[k].contact), reach(order), shown(mine),
                                               shown(other))};
                }
                const auto& contacts = statics.structure().contacts();
                settled.push_back({"opening", contacts[negative[best].contact.index()], mine,
                                   contacts[negative[k].contact.index()], other, order.exponent, order.bits});
                if (difference.negative()) {
                    better = k;
                } else {
                    margin = std::min(margin, difference.margin());
                    rung = std::max(rung, statics.rung());
                }
            } else if (!order.decided || order.sign == 0) {
                tied += fmt::format("; {} (f = {:.17g}): {}", name(statics, negative[k].contact),
                                    negative[k].force.value, reach(order));
            } else if (order.sign < 0) {
                better = k;
            } else {
                margin = std::min(margin, order.margin);
                rung = std::max(rung, order.rung);
            }
        }
        if (better) {
            best = *better;
            continue;
        }
        if (!tied.empty()) {
            return Failure{FailureKind::tie,
                           fmt::format("the opening rule cannot order the contacts {} (f = {:.17g}){}",
                                       name(statics, negative[best].contact), negative[best].force.value, tied)};
        }
        Opening opening{
            negative[best].contact, false, negative[best].force, +1, std::min(margin, negative[best].margin), rung};
        opening.straight_strut = strut;
        opening.perturbed = !settled.empty();
        if (perturbed != nullptr) {
            perturbed->log.insert(perturbed->log.end(), settled.begin(), settled.end());
        }
        return opening;
    }
    return Failure{FailureKind::undecided, "the comparisons of the opening rule contradict each other"};
}

/// One stage of the lexicographic decision: all contacts with `finite` (or without) a finite force.
template <int Dim, class Value, class Expression>
Result<OpeningDecision> stage(Statics<Dim>& statics, bool finite, Value value, Expression force_of, OpeningRule rule,
                              const ZeroHolds& idle, std::uint64_t random_bits, PerturbedStatics<Dim>* perturbed) {
    const auto expression = [&](ContactId l) {
        ForceExpression e = force_of(l);
        e.minus_magnitude = is_held(statics, l);
        return e;
    };
    ZeroHolds zero; // they tie no strut
    if (finite) {
        zero = idle;
        for (std::size_t l = 0; l < statics.structure().contacts().size(); ++l) {
            if (is_held(statics, ContactId(l)) && statics.is_structural_zero(ContactId(l)) && !zero.has(ContactId(l))) {
                zero.others.push_back(ContactId(l));
            }
        }
    }
    std::optional<Turn<Dim>> turn;
    if (zero.fresh) {
        turn.emplace(statics, zero);
    }
    // As far as it is known on the present rung: a held coordinate competes with minus its magnitude.
    const auto contender = [&](ContactId l) {
        const Enclosure f = value(l);
        const Enclosure competes{is_held(statics, l) ? -std::abs(f.value) : f.value, f.radius};
        return Contender{l, competes, competes, competes.margin(), f.value};
    };
    bool without_force = false; // contacts whose force is 0 at the turn itself
    std::vector<Contender> negative;
    double margin = infinity;
    std::vector<Contender> doubtful; // forces whose signs the enclosures do not prove
    for (std::size_t index = 0; index < statics.structure().contacts().size(); ++index) {
        const ContactId l(index);
        if (statics.is_structural_zero(l) == finite || idle.has(l)) {
            continue;
        }
        if (turn && turn->carries_nothing(l)) {
            without_force = true;
            continue;
        }
        const Contender c = contender(l);
        if (c.force.positive()) {
            margin = std::min(margin, c.margin);
        } else {
            (c.force.negative() ? negative : doubtful).push_back(c);
        }
    }
    // A doubtful sign matters when no force is negative, when the rule needs the whole list, or when it could be the
    // smallest.
    const bool whole_list = rule != OpeningRule::most_negative;
    const auto smallest =
        std::min_element(negative.begin(), negative.end(),
                         [](const Contender& a, const Contender& b) { return a.force.value < b.force.value; });
    if (!negative.empty() && !whole_list) {
        const Enclosure least = smallest->force;
        std::erase_if(doubtful, [&](const Contender& d) { return (d.force - least).positive(); });
    }
    std::string zeros;
    OpeningDecision decision;
    for (const Contender& d : doubtful) {
        const Order order = statics.sign(expression(d.contact));
        if (perturbed != nullptr && (!order.decided || order.sign == 0) && is_tie(order, perturbed->size())) {
            const Enclosure f1 = perturbed->force(d.contact);
            if (is_held(statics, d.contact) || !f1.decided()) {
                return Failure{FailureKind::undecided,
                               fmt::format("the force in {} vanishes ({}), {}", name(statics, d.contact), reach(order),
                                           is_held(statics, d.contact)
                                               ? std::string("and held coordinates are not followed at first order")
                                               : fmt::format("and its first-order term does not tell its sign: {}; a "
                                                             "higher order may",
                                                             shown(f1)))};
            }
            const Contact& contact = statics.structure().contacts()[d.contact.index()];
            perturbed->log.push_back(
                {"force", contact, f1, {ContactKind::disk_disk, -1, -1}, {}, order.exponent, order.bits});
            decision.perturbed = true;
            if (f1.negative()) {
                negative.push_back(contender(d.contact));
                negative.back().margin = f1.margin();
            } else {
                margin = std::min(margin, f1.margin());
                decision.zeros.push_back(d.contact);
            }
            continue;
        }
        if (!order.decided) {

            return Failure{FailureKind::undecided,
                           fmt::format("the sign of the {}force in contact {} is not decided with {} bits: {:.3g}, "
                                       "proved to {:.3g}",
                                       finite ? "" : "infinitesimal ", name(statics, d.contact), order.bits,
                                       value(d.contact).value, value(d.contact).radius)};
        }
        if (order.sign < 0) {
            negative.push_back(contender(d.contact));
            negative.back().margin = order.margin;
        } else if (order.sign > 0) {
            margin = std::min(margin, order.margin);
        } else if (is_held(statics, d.contact)) {
            zero.others.push_back(d.contact);
            turn.reset();
            zeros += (zeros.empty() ? "" : ", ") + name(statics, d.contact);
        } else {
            zeros += (zeros.empty() ? "" : ", ") + name(statics, d.contact);
        }
    }
    if (negative.empty()) {
        if (!zeros.empty()) {
            return Failure{finite ? FailureKind::tie : FailureKind::undecided,
                           fmt::format("the {}force is exactly 0, and not for a structural reason, in: {}",
                                       finite ? "" : "infinitesimal ", zeros)};
        }
        if (without_force) {
            return Failure{
                FailureKind::undecided,
                "every force is positive but those of contacts that carry nothing at the power turn: what the "
                "infinitesimal loads make of them there is not followed"};
        }
        decision.margin = margin;
        decision.rung = statics.rung();
        return decision;
    }
    if (!turn && !zero.others.empty()) {
        turn.emplace(statics, zero);
    }
    Result<Opening> picked = pick(statics, negative, expression, rule, random_bits, turn ? &*turn : nullptr, perturbed);
    if (!picked.ok()) {
        return picked.failure();
    }
    Opening opening = picked.value();
    opening.infinitesimal = !finite;
    if (is_held(statics, opening.contact)) {
        opening.force = value(opening.contact);
        const Order push = opening.force.decided() ? Order{true, opening.force.positive() ? 1 : -1}
                                                   : statics.sign(force_of(opening.contact));
        if (!push.decided || push.sign == 0) {
            return Failure{FailureKind::undecided, fmt::format("which way the held coordinate {} pushes is not decided",
                                                               name(statics, opening.contact))};
        }
        opening.direction = push.sign < 0 ? +1 : -1;
    }
    opening.perturbed = opening.perturbed || decision.perturbed;
    decision.perturbed = opening.perturbed;
    decision.opening = opening;
    decision.margin = opening.margin;
    decision.rung = std::max(opening.rung, statics.rung());
    return decision;
}

/// The contacts whose forces vanish together with that of `opens`, which comes first.
template <int Dim> std::vector<ContactId> tie_class(const Statics<Dim>& statics, ContactId opens) {
    std::vector<ContactId> members = statics.vanish_with(opens);
    members.insert(members.begin(), opens);
    return members;
}

/// The contacts that could limit: their slopes are not structural zeros.
template <int Dim> std::vector<ContactId> limiting_candidates(const Statics<Dim>& statics) {
    std::vector<ContactId> candidates;
    for (std::size_t index = 0; index < statics.structure().contacts().size(); ++index) {
        const ContactId l(index);
        if (!is_held(statics, l) && !statics.slope_is_zero(l)) {
            candidates.push_back(l);
        }
    }
    return candidates;
}

/// Proved sign of the rate of a force in `direction`: from the enclosure, or from the ladder.
template <int Dim> Order rate_sign(Statics<Dim>& statics, ContactId l, int direction) {
    const Enclosure slope = statics.slope(l);
    Order order{true, slope.positive() ? 1 : -1, slope.margin(), statics.rung(), statics.bits()};
    if (!slope.decided()) {
        order = statics.sign(statics.slope_expression(l));
    }
    order.sign *= direction;
    return order;
}

template <int Dim> Failure open_rate(const Statics<Dim>& statics, ContactId l, const Order& order) {
    return {FailureKind::undecided,
            fmt::format("the sign of the slope of the force in contact {} is not decided with {} bits: {:.3g}, proved "
                        "to {:.3g}",
                        name(statics, l), order.bits, statics.slope(l).value, statics.slope(l).radius)};
}

/// Within a class of forces that vanish together: the infinitesimal loads decide which one reaches zero first.
template <int Dim> Result<Opening> first_of_class(Statics<Dim>& statics, const std::vector<ContactId>& members) {
    std::vector<Contender> contenders;
    for (const ContactId l : members) {
        if (is_held(statics, l)) {
            continue;
        }
        const Enclosure b = statics.slope(l);
        const Enclosure key =
            members.size() == 1 ? Enclosure{0, 0} : quotient(statics.infinitesimal(l), {std::abs(b.value), b.radius});
        contenders.push_back({l, key, key, infinity, 0});
    }
    const auto expression = [&](ContactId l) {
        ForceExpression e = statics.infinitesimal_expression(l);
        e.divisor = ForceExpression::Divisor::part;
        e.divisor_part = statics.slope_expression(l).part;
        return e;
    };
    return pick(statics, contenders, expression, OpeningRule::most_negative, 0);
}

/// Largest slope: what a zero slope is compared with.
template <int Dim> double slope_size(const Statics<Dim>& statics) {
    double size = 0;
    for (int l = 0; l < statics.structure().size(); ++l) {
        size = std::max(size, std::abs(statics.slope(ContactId(l)).value));
    }
    return size;
}

/// What a pass over the other contacts found out about `first`.
struct Rivals {
    std::optional<ContactId> earlier; ///< proved to vanish before
    std::string tied;                 ///< contacts that vanish at the same load, or cannot be told from it
    double margin = infinity;
    std::vector<TieDecision> settled; ///< ties with `first` that first-order terms settled
};

/// Everything outside the class is still positive at the limit, hence on the whole interval (forces are affine).
template <int Dim>
Result<Rivals> look_at_rivals(Statics<Dim>& statics, double sigma, int direction, ContactId first,
                              const LoadLimit& limit, PerturbedStatics<Dim>* perturbed) {
    const auto& contacts = statics.structure().contacts();
    Rivals rivals;
    std::vector<unsigned char> in_class(statics.structure().contacts().size(), 0);
    for (const ContactId l : limit.tie_class) {
        in_class[l.index()] = 1;
    }
    for (std::size_t index = 0; index < in_class.size(); ++index) {
        const ContactId l(index);
        if (in_class[index] != 0 || is_held(statics, l) || statics.is_structural_zero(l)) {
            continue;
        }
        Enclosure f = statics.force(l, limit.stress);
        f.radius += std::abs(statics.slope(l).value) * limit.stress_error * (1 + 8 * u) +
                    statics.slope(l).radius * limit.stress_error;
        if (f.positive()) {
            rivals.margin = std::min(rivals.margin, f.margin());
            continue;
        }
        if (statics.slope_is_zero(l)) {
            continue; // positive at sigma, and constant
        }
        const Order rate = rate_sign(statics, l, direction);
        if (perturbed != nullptr && (!rate.decided || rate.sign == 0)) {
            // Its slope is of order eps. A force that vanishes in the base is then affine in the load at first order.
            const Order zero = statics.sign(statics.force_expression(l, sigma));
            if (zero.decided && zero.sign > 0 && is_tie(rate, slope_size(statics))) {
                continue;
            }
            const Enclosure f1 = perturbed->force_at(l, limit.stress, limit.stress_error);
            if (!is_tie(rate, slope_size(statics)) || !is_tie(zero, perturbed->size()) || !f1.positive()) {
                return Failure{FailureKind::undecided,
                               fmt::format("the force in {} and its slope vanish in the base; its first-order term at "
                                           "sigma = {:.17g} is {}: where on the way it changes sign is not followed",
                                           name(statics, l), limit.stress, shown(f1))};
            }
            rivals.settled.push_back({"zero all along",
                                      contacts[index],
                                      f1,
                                      {ContactKind::disk_disk, -1, -1},
                                      {},
                                      zero.exponent,
                                      zero.bits});
            rivals.margin = std::min(rivals.margin, f1.margin());
            continue;
        }
        if (!rate.decided) {
            return open_rate(statics, l, rate);
        }
        if (rate.sign >= 0) {
            continue;
        }
        const Order order =
            statics.compare(statics.distance_expression(l, sigma), statics.distance_expression(first, sigma));
        if (perturbed != nullptr && (!order.decided || order.sign == 0) &&
            is_tie(order, std::max(std::abs(limit.stress), std::abs(sigma)))) {
            Enclosure mine = perturbed->limit_rate(first, limit.stress, limit.stress_error);
            Enclosure other = perturbed->limit_rate(l, limit.stress, limit.stress_error);
            const Enclosure difference = direction > 0 ? other - mine : mine - other;
            if (!difference.decided()) {
                return Failure{FailureKind::undecided,
                               fmt::format("tied at first order too: the forces in {} and {} vanish at one load, sigma "
                                           "= {:.17g} ({}), and the first-order terms of the two loads are {} and {}",
                                           name(statics, first), name(statics, l), limit.stress, reach(order),
                                           shown(mine), shown(other))};
            }
            if (difference.negative()) {
                rivals.earlier = l;
                return rivals;
            }
            rivals.settled.push_back(
                {"limit", contacts[first.index()], mine, contacts[index], other, order.exponent, order.bits});
            rivals.margin = std::min(rivals.margin, difference.margin());
            continue;
        }
        if (order.decided && order.sign < 0) {
            rivals.earlier = l;
            return rivals;
        }
        if (!order.decided || order.sign == 0) {
            rivals.tied += fmt::format(", {} ({})", name(statics, l), reach(order));
        } else {
            rivals.margin = std::min(rivals.margin, order.margin);
        }
    }
    return rivals;
}

} // namespace

template <int Dim>
Result<OpeningDecision> decide_opening(Statics<Dim>& statics, double sigma, OpeningRule rule, const ZeroHolds& zero,
                                       std::uint64_t random_bits, PerturbedStatics<Dim>* perturbed) {
    auto finite = stage(
        statics, true, [&](ContactId l) { return statics.force(l, sigma); },
        [&](ContactId l) { return statics.force_expression(l, sigma); }, rule, zero, random_bits, perturbed);
    if (!finite.ok() || finite.value().opening) {
        return finite;
    }
    auto infinitesimal = stage(
        statics, false, [&](ContactId l) { return statics.infinitesimal(l); },
        [&](ContactId l) { return statics.infinitesimal_expression(l); }, rule, zero, random_bits,
        static_cast<PerturbedStatics<Dim>*>(nullptr)); // the loads are smaller than every power of eps
    if (infinitesimal.ok()) {
        infinitesimal.value().perturbed = finite.value().perturbed;
        infinitesimal.value().zeros = finite.value().zeros;
        infinitesimal.value().margin = std::min(infinitesimal.value().margin, finite.value().margin);
    }
    return infinitesimal;
}

template <int Dim>
Result<LoadLimit> find_limit(Statics<Dim>& statics, double sigma, int direction, PerturbedStatics<Dim>* perturbed) {
    const std::vector<ContactId> candidates = limiting_candidates(statics);
    ContactId first;
    double smallest = infinity;
    for (const ContactId l : candidates) {
        const double rate = direction * statics.slope(l).value;
        if (perturbed != nullptr && !statics.slope(l).decided()) {
            continue; // it may vanish in the base: looked at with the rivals
        }
        const double distance = rate < 0 ? statics.force(l, sigma).value / -rate : infinity;
        if (distance < smallest) {
            smallest = distance;
            first = l;
        }
    }
    if (!first.valid()) { // as far as rounded numbers tell
        for (const ContactId l : candidates) {
            const Order rate = rate_sign(statics, l, direction);
            if (perturbed != nullptr && (!rate.decided || rate.sign == 0)) {
                const Order zero = statics.sign(statics.force_expression(l, sigma));
                if (is_tie(rate, slope_size(statics)) && zero.decided && zero.sign > 0) {
                    continue; // it changes by O(eps) over any finite way
                }
            }
            if (!rate.decided || (perturbed != nullptr && rate.sign == 0)) {
                return open_rate(statics, l, rate);
            }
            if (rate.sign < 0) {
                first = l;
                break;
            }
        }
        if (!first.valid()) {
            return LoadLimit{true, direction * infinity, 0, ContactId(), {}, infinity, statics.rung()};
        }
    }
    // Whoever is proved to vanish earlier takes the place of the first guess, at most once per contact.
    for (std::size_t restart = 0; restart <= candidates.size(); ++restart) {
        const Order rate = rate_sign(statics, first, direction);
        if (!rate.decided) {
            return open_rate(statics, first, rate);
        }
        if (rate.sign >= 0) { // the guess was wrong: any other that decreases
            ContactId other;
            for (const ContactId l : candidates) {
                const Order of_l = rate_sign(statics, l, direction);
                if (!of_l.decided) {
                    return open_rate(statics, l, of_l);
                }
                if (of_l.sign < 0) {
                    other = l;
                    break;
                }
            }
            if (!other.valid()) {
                return LoadLimit{true, direction * infinity, 0, ContactId(), {}, infinity, statics.rung()};
            }
            first = other;
            continue;
        }
        LoadLimit limit;
        const Enclosure slope = statics.slope(first);
        limit.stress = sigma + direction * (statics.force(first, sigma).value / std::abs(slope.value));
        const Enclosure at_limit = statics.force(first, limit.stress);
        limit.stress_error = slope.decided() ? (std::abs(at_limit.value) + at_limit.radius) /
                                                   (std::abs(slope.value) - slope.radius) * (1 + 8 * u)
                                             : infinity;
        limit.margin = rate.margin;
        limit.tie_class = tie_class(statics, first);
        const Result<Rivals> rivals = look_at_rivals(statics, sigma, direction, first, limit, perturbed);
        if (!rivals.ok()) {
            return rivals.failure();
        }
        if (rivals.value().earlier) {
            first = *rivals.value().earlier;
            continue;
        }
        if (!rivals.value().tied.empty()) {
            return Failure{FailureKind::tie,
                           fmt::format("the forces in the contacts {}{} vanish at one load, sigma = {:.17g}",
                                       name(statics, first), rivals.value().tied, limit.stress)};
        }
        const Result<Opening> chosen = first_of_class(statics, limit.tie_class);
        if (!chosen.ok()) {
            return Failure{chosen.failure().kind, fmt::format("structural tie class of {} contacts: {}",
                                                              limit.tie_class.size(), chosen.failure().message)};
        }
        limit.opens = chosen.value().contact;
        limit.margin = std::min(limit.margin, rivals.value().margin);
        if (limit.tie_class.size() > 1) {
            limit.margin = std::min(limit.margin, chosen.value().margin);
        }
        limit.rung = statics.rung();
        if (perturbed != nullptr) {
            const std::vector<TieDecision>& settled = rivals.value().settled;
            perturbed->log.insert(perturbed->log.end(), settled.begin(), settled.end());
            limit.perturbed = !settled.empty();
        }
        return limit;
    }
    return Failure{FailureKind::undecided, "the comparisons of the limit loads contradict each other"};
}

template Result<OpeningDecision> decide_opening<2>(Statics<2>&, double, OpeningRule, const ZeroHolds&, std::uint64_t,
                                                   PerturbedStatics<2>*);
template Result<LoadLimit> find_limit<2>(Statics<2>&, double, int, PerturbedStatics<2>*);

} // namespace isostat
