#include "core/roundoff.hpp"
#include "statics/contender.hpp"
#include "statics/quotient.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isostat {

namespace {

using roundoff::infinity;
using roundoff::u;

Comparison proved_larger(double margin) {
    Comparison result;
    result.answer = Comparison::Answer::larger;
    result.margin = margin;
    return result;
}

/// Which force vanishes first when the loaded stress changes in one direction: contacts, by number.
class LimitContest final : public Contest {
  public:
    LimitContest(Statics& statics, double sigma, int direction, PerturbedStatics* perturbed)
        : statics_(statics), contacts_(statics.structure().contacts()), sigma_(sigma), direction_(direction),
          perturbed_(perturbed) {
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (contacts_[l].is_unilateral() && !statics_.slope_is_zero(ContactId(l))) {
                candidates_.emplace_back(l);
            }
        }
    }
    [[nodiscard]] std::size_t size() const override { return contacts_.size(); }
    Result<std::optional<std::size_t>> stand(std::size_t best) override;
    Result<Comparison> compare(std::size_t rival, std::size_t best) override;

    /// The first candidate: by rounded numbers, then by proved rates. Nothing: no force decreases.
    Result<std::optional<std::size_t>> guess();
    /// The force is 0 up to the limit in the base, where ties are chosen: it opens nothing.
    bool stays_zero(ContactId l) {
        return perturbed_ != nullptr && perturbed_->chooses() && is_tie(rate_sign(l), slope_size());
    }
    /// A member of the class of the limiting force that opens nothing: its own force stays at 0, or grows from 0.
    /// Without ties all of a class are positive before, and fall.
    bool opens_nothing(ContactId l) { return stays_zero(l) || (perturbed_ != nullptr && rate_sign(l).sign > 0); }
    /// The load at which the force of the last candidate vanishes, and the forces that vanish with it.
    [[nodiscard]] const LoadLimit& limit() const { return limit_; }

  private:
    /// Proved sign of the rate of a force in the direction: from the enclosure, or from the ladder.
    Order rate_sign(ContactId l);
    [[nodiscard]] Failure open_rate(ContactId l, const Order& order) const;
    [[nodiscard]] Named name_of(ContactId l) const { return name(statics_, l); }
    /// Largest slope, the scale for zero slopes.
    [[nodiscard]] double slope_size() const;
    /// The force at the limit, for every load within its error.
    [[nodiscard]] Enclosure at_limit(ContactId l) const;
    void add_to_class(ContactId l);
    Result<Comparison> with_a_rate_of_order_eps(ContactId l, const Order& rate);
    Result<Comparison> at_first_order(ContactId l, ContactId first, const Order& order);

    Statics& statics_;
    const std::vector<Contact>& contacts_;
    double sigma_;
    int direction_;
    PerturbedStatics* perturbed_;
    std::vector<ContactId> candidates_; ///< that could limit: their slopes are not structural zeros
    LoadLimit limit_;
    std::vector<unsigned char> in_class_; ///< of contacts: vanish with the limiting one for structural reasons
};

Order LimitContest::rate_sign(ContactId l) {
    Enclosure slope = statics_.slope(l);
    if (!slope.decided() && statics_.rung() == Rung::double_bound && statics_.climb()) {
        slope = statics_.slope(l);
    }
    Order order{true, slope.positive() ? 1 : -1, slope.margin(), statics_.rung(), statics_.bits()};
    if (!slope.decided()) {
        order = statics_.slope_cancels(l) ? Order{true, 0, infinity, Rung::combinatorial, 0}
                                          : statics_.sign(statics_.slope_expression(l));
    }
    order.sign *= direction_;
    return order;
}

Failure LimitContest::open_rate(ContactId l, const Order& order) const {
    return failed(FailureKind::undecided,
                  "the sign of the slope of the force in contact {} is not decided with {} bits: {:.3g}, proved to "
                  "{:.3g}",
                  name_of(l), order.bits, statics_.slope(l).value, statics_.slope(l).radius);
}

double LimitContest::slope_size() const {
    double size = 0;
    for (int l = 0; l < statics_.structure().size(); ++l) {
        size = std::max(size, std::abs(statics_.slope(ContactId(l)).value));
    }
    return size;
}

Result<std::optional<std::size_t>> LimitContest::guess() {
    const auto first = first_to_vanish(
        candidates_.size(), [this](std::size_t k) { return statics_.force(candidates_[k], sigma_).value; },
        [this](std::size_t k) { // slopes that may vanish are judged with the rivals
            const Enclosure slope = statics_.slope(candidates_[k]);
            return perturbed_ != nullptr && !slope.decided() ? 0.0 : direction_ * slope.value;
        });
    if (first) {
        return std::optional(candidates_[first->index].index());
    }
    for (const ContactId l : candidates_) {
        const Order rate = rate_sign(l);
        if (perturbed_ != nullptr && (!rate.decided || rate.sign == 0)) {
            const Order zero = statics_.sign(statics_.force_expression(l, sigma_));
            const bool stays_positive = zero.decided && zero.sign > 0;
            const bool stays_zero = perturbed_->chooses() && is_tie(zero, perturbed_->size());
            if (is_tie(rate, slope_size()) && (stays_positive || stays_zero)) {
                continue; // it changes by O(eps) over any finite change of the load
            }
        }
        if (!rate.decided || (perturbed_ != nullptr && rate.sign == 0)) {
            return open_rate(l, rate);
        }
        if (rate.sign < 0) {
            return std::optional(l.index());
        }
    }
    return std::optional<std::size_t>();
}

Result<std::optional<std::size_t>> LimitContest::stand(std::size_t best) {
    const ContactId first(best);
    const Order rate = rate_sign(first);
    if (!rate.decided) {
        return open_rate(first, rate);
    }
    if (rate.sign >= 0) { // the guess was wrong: take any other that decreases
        for (const ContactId l : candidates_) {
            const Order other = rate_sign(l);
            if (!other.decided) {
                return open_rate(l, other);
            }
            if (other.sign < 0) {
                return std::optional(l.index());
            }
        }
        return std::optional<std::size_t>();
    }
    limit_ = LoadLimit();
    const Enclosure slope = statics_.slope(first);
    limit_.stress = sigma_ + direction_ * (statics_.force(first, sigma_).value / std::abs(slope.value));
    const Enclosure there = statics_.force(first, limit_.stress);
    limit_.stress_error =
        // precision.md B9
        slope.decided() ? (std::abs(there.value) + there.radius) / (std::abs(slope.value) - slope.radius) * (1 + 8 * u)
                        : infinity;
    limit_.margin = rate.margin;
    limit_.tie_class.clear();
    in_class_.assign(contacts_.size(), 0);
    add_to_class(first);
    for (const EqualForce& equal : equal_by_place(statics_, first)) {
        add_to_class(equal.contact);
    }
    return std::optional(best);
}

/// Adds a contact whose force vanishes at the limit, and those that vanish with it by counting.
void LimitContest::add_to_class(ContactId l) {
    std::vector<ContactId> members = statics_.vanish_with(l);
    members.insert(members.begin(), l);
    for (const ContactId member : members) {
        if (std::exchange(in_class_[member.index()], 1) == 0 && !is_bar(statics_, member)) {
            limit_.tie_class.push_back(member);
        }
    }
}

Enclosure LimitContest::at_limit(ContactId l) const {
    Enclosure f = statics_.force(l, limit_.stress);
    f.radius += std::abs(statics_.slope(l).value) * limit_.stress_error * (1 + 8 * u) + // precision.md B9
                statics_.slope(l).radius * limit_.stress_error;
    return f;
}

/// Every force outside the class is still positive at the limit, hence on the whole interval (forces are affine).
Result<Comparison> LimitContest::compare(std::size_t rival, std::size_t best) {
    const ContactId l(rival);
    const ContactId first(best);
    if (in_class_[rival] != 0 || !contacts_[rival].is_unilateral() || statics_.is_structural_zero(l)) {
        return Comparison{};
    }
    const Enclosure f = at_limit(l);
    if (f.positive()) {
        return proved_larger(f.margin());
    }
    if (statics_.slope_is_zero(l)) {
        return Comparison{}; // positive at sigma, and constant
    }
    const Order rate = rate_sign(l);
    if (perturbed_ != nullptr && (!rate.decided || rate.sign == 0)) {
        return with_a_rate_of_order_eps(l, rate);
    }
    if (!rate.decided) {
        return open_rate(l, rate);
    }
    if (rate.sign >= 0) {
        return Comparison{};
    }
    const Order order =
        statics_.compare(statics_.distance_expression(l, sigma_), statics_.distance_expression(first, sigma_));
    if (perturbed_ != nullptr && needs_first_order(order, std::max(std::abs(limit_.stress), std::abs(sigma_)))) {
        return at_first_order(l, first, order);
    }
    return by_order(order, [&] { return words(", {} ({})", name_of(l), reach(order)); });
}

/// A force that vanishes in the base is then affine in the load at first order.
Result<Comparison> LimitContest::with_a_rate_of_order_eps(ContactId l, const Order& rate) {
    const Order zero = statics_.sign(statics_.force_expression(l, sigma_));
    if (zero.decided && zero.sign > 0 && is_tie(rate, slope_size())) {
        return Comparison{};
    }
    const Enclosure f1 = perturbed_->force_at(l, limit_.stress, limit_.stress_error);
    const bool vanishes = is_tie(rate, slope_size()) && is_tie(zero, perturbed_->size());
    if (!vanishes || !(f1.positive() || perturbed_->chooses())) {
        return failed(FailureKind::undecided,
                      "the force in {} and its slope vanish in the base; its first-order term at "
                      "sigma = {:.17g} is {}: where on the way it changes sign is not followed",
                      name_of(l), limit_.stress, shown(f1));
    }
    Comparison result = proved_larger(f1.positive() ? f1.margin() : infinity);
    result.settled = TieDecision{
        "zero all along", contacts_[l.index()], f1, {ContactKind::disk_disk, -1, -1}, {}, zero.exponent, zero.bits};
    result.settled->choice = f1.positive() ? TieChoice::none : TieChoice::zero;
    return result;
}

Result<Comparison> LimitContest::at_first_order(ContactId l, ContactId first, const Order& order) {
    const Enclosure mine = perturbed_->limit_rate(first, limit_.stress, limit_.stress_error);
    const Enclosure other = perturbed_->limit_rate(l, limit_.stress, limit_.stress_error);
    return by_first_order({"limit", contacts_[first.index()], mine, contacts_[l.index()], other}, order,
                          {direction_ < 0, perturbed_->chooses(), statics_.rung()},
                          words("the forces in {} and {} vanish at one load, sigma = {:.17g} ({}), and the "
                                "first-order terms of the two loads",
                                name_of(first), name_of(l), limit_.stress, reach(order)));
}

/// Within a class of forces that vanish together the infinitesimal loads decide which one reaches zero first.
Result<Opening> first_of_class(Statics& statics, const std::vector<ContactId>& members) {
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
    Choice choice;
    choice.quantity = [&statics](ContactId l) {
        ForceExpression e = statics.infinitesimal_expression(l);
        e.divisor_part = statics.slope_expression(l).part;
        return e;
    };
    return pick(statics, std::move(contenders), choice);
}

/// Among forces that vanish at one load, tied at first order: the infinitesimal loads select the one that ends the
/// interval, or the names. The contest then has this one as its best.
std::optional<Failure> choose(Statics& statics, LimitContest& contest, Minimum& minimum) {
    const auto found = choosable(contest, minimum);
    if (!found.ok()) {
        return found.failure();
    }
    std::vector<ContactId> members;
    for (const std::size_t l : found.value()) {
        members.emplace_back(l);
    }
    if (members.empty()) {
        return failed(FailureKind::tie, "the forces in the contacts {}{} vanish at one load, sigma = {:.17g}",
                      name(statics, ContactId(*minimum.index)), minimum.tied, contest.limit().stress);
    }
    const auto& contacts = statics.structure().contacts();
    const Result<Opening> by_loads = first_of_class(statics, members);
    const ContactId chosen =
        by_loads.ok() ? by_loads.value().contact : *std::ranges::min_element(members, [&](ContactId a, ContactId b) {
            return contacts[a.index()] < contacts[b.index()];
        });
    const auto record =
        recorded_choice(minimum, found.value(), chosen.index(), by_loads.ok() ? TieChoice::loads : TieChoice::names);
    minimum.settled.insert(minimum.settled.end(), record.begin(), record.end());
    minimum.index = chosen.index();
    const auto stands = contest.stand(chosen.index());
    return stands.ok() ? std::nullopt : std::optional<Failure>(stands.failure());
}

LoadLimit unbounded(int direction, Rung rung) {
    return {true, direction * infinity, 0, ContactId(), {}, infinity, rung};
}

} // namespace

Result<LoadLimit> find_limit(Statics& statics, double sigma, int direction, PerturbedStatics* perturbed) {
    LimitContest contest(statics, sigma, direction, perturbed);
    const auto guess = contest.guess();
    if (!guess.ok()) {
        return guess.failure();
    }
    if (!guess.value()) {
        return unbounded(direction, statics.rung());
    }
    auto found = proved_minimum(contest, *guess.value(), "the comparisons of the limit loads contradict each other");
    if (!found.ok()) {
        return found.failure();
    }
    Minimum& minimum = found.value();
    if (!minimum.index) {
        return unbounded(direction, statics.rung());
    }
    if (!minimum.tied.empty()) {
        if (auto failure = choose(statics, contest, minimum)) {
            return *failure;
        }
    }
    LoadLimit limit = contest.limit();
    std::erase_if(limit.tie_class,
                  [&](ContactId l) { return l.index() != *minimum.index && contest.opens_nothing(l); });
    const Result<Opening> chosen = first_of_class(statics, limit.tie_class);
    if (!chosen.ok()) {
        return failed(chosen.failure().kind, "structural tie class of {} contacts: {}", limit.tie_class.size(),
                      chosen.failure());
    }
    limit.opens = chosen.value().contact;
    limit.margin = std::min(limit.margin, minimum.margin);
    if (limit.tie_class.size() > 1) {
        limit.margin = std::min(limit.margin, chosen.value().margin);
    }
    limit.rung = statics.rung();
    if (perturbed != nullptr) {
        perturbed->log.insert(perturbed->log.end(), minimum.settled.begin(), minimum.settled.end());
        limit.perturbed = !minimum.settled.empty();
    }
    return limit;
}

} // namespace isostat
