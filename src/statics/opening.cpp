#include "core/roundoff.hpp"
#include "statics/contender.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::infinity;

/// One stage of the lexicographic decision: all contacts with a finite force, or all without.
class Stage {
  public:
    Stage(Statics& statics, bool finite, double sigma, const ZeroHolds& idle, Choice choice)
        : statics_(statics), contacts_(statics.structure().contacts()), finite_(finite), sigma_(sigma), idle_(idle),
          choice_(std::move(choice)) {
        choice_.quantity = [this](ContactId l) { return quantity(l); };
        if (finite_) { // the infinitesimal stage has no ties of struts
            find_zero_holds();
        }
        if (zero_.fresh.valid()) {
            ask_struts();
        }
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    Result<OpeningDecision> decide() {
        sort_by_sign();
        leave_out_what_cannot_open();
        for (const Contender& d : doubtful_) {
            if (auto failure = settle(d)) {
                return *failure;
            }
        }
        return negative_.empty() ? nothing_opens() : open();
    }

  private:
    /// Struts exist in the plane (S4).
    void ask_struts() {
        if (statics_.structure().dofs().layout().dimension == plane) {
            turn_.emplace(statics_, zero_);
        }
    }
    [[nodiscard]] Named name_of(ContactId l) const { return name(statics_, l); }
    [[nodiscard]] Enclosure value(ContactId l) const {
        return finite_ ? statics_.force(l, sigma_) : statics_.infinitesimal(l);
    }
    [[nodiscard]] ForceExpression force(ContactId l) const {
        return finite_ ? statics_.force_expression(l, sigma_) : statics_.infinitesimal_expression(l);
    }
    /// A held coordinate competes with minus its magnitude.
    [[nodiscard]] ForceExpression quantity(ContactId l) const {
        ForceExpression e = force(l);
        e.minus_magnitude = is_held(statics_, l);
        return e;
    }
    /// The contender with the precision of the present rung.
    [[nodiscard]] Contender contender(ContactId l) const {
        const Enclosure f = value(l);
        const Enclosure competes{is_held(statics_, l) ? -std::abs(f.value) : f.value, f.radius};
        return Contender{l, competes, competes, competes.margin(), f.value};
    }

    /// \pre some force is negative
    [[nodiscard]] const Contender& most_negative() const {
        return *std::ranges::min_element(negative_, {}, [](const Contender& c) { return c.force.value; });
    }
    [[nodiscard]] bool may_tie() const;
    void find_zero_holds();
    void sort_by_sign();
    void leave_out_what_cannot_open();
    /// Decides the sign of a force that its enclosure leaves open.
    std::optional<Failure> settle(const Contender& doubtful);
    std::optional<Failure> settle_at_first_order(ContactId l, const Order& order);
    void add_negative(ContactId l, double margin) {
        negative_.push_back(contender(l));
        negative_.back().margin = margin;
    }
    Result<OpeningDecision> nothing_opens();
    Result<OpeningDecision> open();
    /// Releases a held coordinate in the direction of its multiplier.
    std::optional<Failure> let_go(Opening& opening);

    Statics& statics_;
    const std::vector<Contact>& contacts_;
    bool finite_;
    double sigma_;
    const ZeroHolds& idle_;
    Choice choice_;
    ZeroHolds zero_;
    std::optional<Turn> turn_;
    std::vector<Contender> negative_;
    std::vector<Contender> doubtful_; ///< forces whose signs the enclosures do not prove
    bool without_force_ = false;      ///< some contacts have force 0 at the exact turn
    double margin_ = infinity;        ///< of the positive forces
    Words zeros_;                     ///< forces that are exactly 0
    OpeningDecision decision_;
};

void Stage::find_zero_holds() {
    zero_ = idle_;
    for (std::size_t l = 0; l < contacts_.size(); ++l) {
        const ContactId id(l);
        if (is_held(statics_, id) && statics_.is_structural_zero(id) && !zero_.has(id)) {
            zero_.others.push_back(id);
        }
    }
}

void Stage::sort_by_sign() {
    for (std::size_t index = 0; index < contacts_.size(); ++index) {
        const ContactId l(index);
        if (statics_.is_structural_zero(l) == finite_ || idle_.has(l) || is_bar(statics_, l)) {
            continue;
        }
        if (turn_ && turn_->carries_nothing(l)) {
            without_force_ = true;
            continue;
        }
        const Contender c = contender(l);
        if (c.force.positive()) {
            margin_ = std::min(margin_, c.margin);
        } else {
            (c.force.negative() ? negative_ : doubtful_).push_back(c);
        }
    }
}

/// A doubtful sign matters when no force is negative, when the rule
/// needs the whole list, or when the force could be the smallest.
void Stage::leave_out_what_cannot_open() {
    if (negative_.empty() || choice_.rule != OpeningRule::most_negative) {
        return;
    }
    const Enclosure least = most_negative().force;
    std::erase_if(doubtful_, [&](const Contender& d) { return (d.force - least).positive(); });
}

std::optional<Failure> Stage::settle(const Contender& doubtful) {
    const ContactId l = doubtful.contact;
    const Order order = statics_.sign(quantity(l));
    if (choice_.perturbed != nullptr && needs_first_order(order, choice_.perturbed->size())) {
        return settle_at_first_order(l, order);
    }
    if (!order.decided) {
        return failed(FailureKind::undecided,
                      "the sign of the {}force in contact {} is not decided with {} bits: {:.3g}, "
                      "proved to {:.3g}",
                      finite_ ? "" : "infinitesimal ", name_of(l), order.bits, value(l).value, value(l).radius);
    }
    if (order.sign < 0) {
        add_negative(l, order.margin);
    } else if (order.sign > 0) {
        margin_ = std::min(margin_, order.margin);
    } else {
        zeros_ += words("{}{}", zeros_.empty() ? "" : ", ", name_of(l));
        if (is_held(statics_, l)) {
            zero_.others.push_back(l);
            turn_.reset();
        }
    }
    return std::nullopt;
}

std::optional<Failure> Stage::settle_at_first_order(ContactId l, const Order& order) {
    const Enclosure f1 = choice_.perturbed->force(l);
    const bool held = is_held(statics_, l);
    const bool stays_zero = !held && !f1.positive() && choice_.perturbed->chooses(); // it opens nothing (C1 d)
    if (held || (!f1.decided() && !stays_zero)) {
        return failed(FailureKind::undecided, "the force in {} vanishes ({}), {}", name_of(l), reach(order),
                      held ? std::string("and held coordinates are not followed at first order")
                           : fmt::format("and its first-order term does not tell its sign: {}; a "
                                         "higher order may",
                                         shown(f1)));
    }
    choice_.perturbed->log.push_back({"force",
                                      contacts_[l.index()],
                                      f1,
                                      {ContactKind::disk_disk, -1, -1},
                                      {},
                                      order.exponent,
                                      order.bits,
                                      stays_zero ? TieChoice::zero : TieChoice::none});
    decision_.perturbed = true;
    if (f1.negative() && !stays_zero) {
        add_negative(l, f1.margin());
    } else {
        margin_ = stays_zero ? margin_ : std::min(margin_, f1.margin());
        decision_.zeros.push_back(l);
    }
    return std::nullopt;
}

Result<OpeningDecision> Stage::nothing_opens() {
    if (!zeros_.empty()) {
        return failed(finite_ ? FailureKind::tie : FailureKind::undecided,
                      "the {}force is exactly 0, and not for a structural reason, in: {}",
                      finite_ ? "" : "infinitesimal ", zeros_);
    }
    if (without_force_) {
        return Failure{FailureKind::undecided,
                       "every force is positive but those of contacts that carry nothing at the power turn: what the "
                       "infinitesimal loads make of them there is not followed"};
    }
    if (finite_ && idle_.fresh.valid() && !statics_.is_structural_zero(idle_.fresh)) {
        return failed(FailureKind::undecided,
                      "every force is positive where the power turned and {} is held: the mechanism would stand at a "
                      "minimum of the potential, which disks do not have (S3), or the turn is not known well enough",
                      name_of(idle_.fresh));
    }
    decision_.margin = margin_;
    decision_.rung = statics_.rung();
    return decision_;
}

/// Whether the strut of the contact that opens may matter: enclosures of equal forces overlap (S4), except at a turn
/// that was just located, or where what is held turned back: the forces there are not those of the exact turn.
bool Stage::may_tie() const {
    if (zero_.fresh.valid() || !idle_.others.empty() || !finite_ || choice_.rule != OpeningRule::most_negative) {
        return true;
    }
    const Contender& least = most_negative();
    return std::ranges::any_of(negative_, [&](const Contender& c) {
        return c.contact != least.contact && !(c.force - least.force).decided();
    });
}

Result<OpeningDecision> Stage::open() {
    if (!turn_ && !zero_.others.empty() && may_tie()) {
        ask_struts();
    }
    choice_.turn = turn_ ? &*turn_ : nullptr;
    const auto picked = pick(statics_, std::move(negative_), choice_);
    if (!picked.ok()) {
        return picked.failure();
    }
    Opening opening = picked.value();
    opening.infinitesimal = !finite_;
    opening.bears = !finite_ && grains_bear_force(contacts_, opening.contact, [this](std::size_t l) {
        return statics_.is_structural_zero(ContactId(l));
    });
    if (auto failure = let_go(opening)) {
        return *failure;
    }
    opening.perturbed = opening.perturbed || decision_.perturbed;
    decision_.perturbed = opening.perturbed;
    decision_.opening = opening;
    decision_.margin = opening.margin;
    decision_.rung = std::max(opening.rung, statics_.rung());
    return decision_;
}

std::optional<Failure> Stage::let_go(Opening& opening) {
    const ContactId l = opening.contact;
    if (!is_held(statics_, l)) {
        return std::nullopt;
    }
    opening.force = value(l);
    const Order push =
        opening.force.decided() ? Order{true, opening.force.positive() ? 1 : -1} : statics_.sign(force(l));
    if (!push.decided || push.sign == 0) {
        return failed(FailureKind::undecided, "which way the held coordinate {} pushes is not decided", name_of(l));
    }
    opening.direction = push.sign < 0 ? +1 : -1;
    return std::nullopt;
}

} // namespace

Result<OpeningDecision> decide_opening(Statics& statics, double sigma, OpeningRule rule, const ZeroHolds& zero,
                                       std::uint64_t random_bits, PerturbedStatics* perturbed) {
    auto finite = Stage(statics, true, sigma, zero, {rule, random_bits, {}, nullptr, perturbed}).decide();
    if (!finite.ok() || finite.value().opening) {
        return finite;
    }
    // The loads are smaller than every power of eps, so this stage has no first-order terms.
    auto infinitesimal = Stage(statics, false, sigma, zero, {rule, random_bits, {}, nullptr, nullptr}).decide();
    if (infinitesimal.ok()) {
        infinitesimal.value().perturbed = finite.value().perturbed;
        infinitesimal.value().zeros = finite.value().zeros;
        infinitesimal.value().margin = std::min(infinitesimal.value().margin, finite.value().margin);
    }
    return infinitesimal;
}

} // namespace isostat
