#include "core/roundoff.hpp"
#include "statics/contender.hpp"

#include <algorithm>

namespace isostat {

namespace {

using roundoff::infinity;

/// The contenders in the order of the rule.
class OpeningContest final : public Contest {
  public:
    OpeningContest(Statics& statics, std::vector<Contender>& contenders, const Choice& choice)
        : statics_(statics), contenders_(contenders), choice_(choice),
          least_(choice.rule == OpeningRule::least_negative) {
        for (Contender& c : contenders_) {
            c.key = least_ ? Enclosure{-c.force.value, c.force.radius} : c.force;
        }
    }
    [[nodiscard]] std::size_t size() const override { return contenders_.size(); }
    /// A contact with the same force as the current best is among the contenders.
    [[nodiscard]] bool equal_met() const { return equal_met_; }

    Result<std::optional<std::size_t>> stand(std::size_t best) override {
        equal_met_ = false;
        const ContactId of = contenders_[best].contact;
        equal_ = equal_by_place(statics_, of);
        if (choice_.turn != nullptr) {
            const std::vector<EqualForce> ends = choice_.turn->mates(of);
            equal_.insert(equal_.end(), ends.begin(), ends.end());
        }
        return std::optional(best);
    }

    Result<Comparison> compare(std::size_t rival, std::size_t best) override {
        const Contender& one = contenders_[best];
        const Contender& other = contenders_[rival];
        const auto equal =
            std::ranges::find_if(equal_, [&](const EqualForce& e) { return e.contact == other.contact; });
        if (equal != equal_.end()) {
            return by_loads(equal->excess, other);
        }
        const Order order = by_enclosure_or_ladder(other, one);
        if (choice_.perturbed != nullptr && needs_first_order(order, choice_.perturbed->size())) {
            return at_first_order(order, other, one);
        }
        return by_order(order, [&] {
            return words("; {} (f = {:.17g}): {}", name(statics_, other.contact), other.force.value, reach(order));
        });
    }

  private:
    /// The two ends of a strut that a power turn leaves straight (S4), two walls of an edge (S6), and two members that
    /// lie level (S7) bear one force: the infinitesimal loads order them, not the digits of the located turn or vertex.
    Comparison by_loads(const Enclosure& excess, const Contender& other) {
        equal_met_ = true;
        Order order{excess.decided(), excess.positive() == least_ ? -1 : 1, excess.margin(), Rung::combinatorial};
        return by_order(order, [&] {
            return words("; {} (f = {:.17g}): {} bear one force, which the infinitesimal loads do not order: {:.3g}, "
                         "known to {:.3g}",
                         name(statics_, other.contact), other.force.value,
                         choice_.turn != nullptr ? "the ends of a straight strut, or contacts of an edge or notch"
                                                 : "contacts of an edge or notch",
                         excess.value, excess.radius);
        });
    }

    /// The difference of two enclosures if it decides, else the ladder.
    Order by_enclosure_or_ladder(const Contender& other, const Contender& one) {
        const Enclosure difference = other.key - one.key;
        if (difference.decided()) {
            return {true, difference.positive() ? 1 : -1, difference.margin(), statics_.rung(), statics_.bits()};
        }
        Order order = statics_.compare(choice_.quantity(other.contact), choice_.quantity(one.contact));
        order.sign = least_ ? -order.sign : order.sign; // quantities are forces, keys their opposites
        return order;
    }

    Result<Comparison> at_first_order(const Order& order, const Contender& other, const Contender& one) {
        const auto& contacts = statics_.structure().contacts();
        const Enclosure mine = first_order_key(one);
        const Enclosure its = first_order_key(other);
        return by_first_order({"opening", contacts[one.contact.index()], mine, contacts[other.contact.index()], its},
                              order, {false, choice_.perturbed->chooses(), statics_.rung()},
                              words("the opening rule cannot order {} and {} ({}), and the first-order terms of "
                                    "what it compares",
                                    name(statics_, one.contact), name(statics_, other.contact), reach(order)));
    }

    /// First-order term of the key, for a contender of the finite stage.
    Enclosure first_order_key(const Contender& c) {
        Enclosure f1 = choice_.perturbed->force(c.contact);
        // A held coordinate competes with -|m|: its derivative is -sign(m) m1, and the force of the contender is -|m|.
        const bool flipped = is_held(statics_, c.contact) && c.multiplier > 0;
        if (flipped != least_) {
            f1.value = -f1.value;
        }
        return f1;
    }

    Statics& statics_;
    std::vector<Contender>& contenders_;
    const Choice& choice_;
    bool least_;
    bool equal_met_ = false;
    std::vector<EqualForce> equal_; ///< forces equal to that of the current best
};

/// The position of the opening contact among `count` contacts sorted by name, for rules that compare no numbers.
std::optional<std::size_t> rule_place(OpeningRule rule, std::size_t count, std::uint64_t random_bits) {
    return rule == OpeningRule::random        ? std::optional<std::size_t>(random_bits % count)
           : rule == OpeningRule::least_index ? std::optional<std::size_t>(0)
                                              : std::nullopt;
}

/// Ordered by name, so that the choice does not depend on the order of the contact list.
Opening pick_by_name(const Statics& statics, std::vector<Contender>& contenders, std::size_t place) {
    std::ranges::sort(contenders, [&](const Contender& a, const Contender& b) {
        const auto& contacts = statics.structure().contacts();
        return contacts[a.contact.index()] < contacts[b.contact.index()];
    });
    const Contender& chosen = contenders[place];
    return {chosen.contact, false, chosen.force, +1, chosen.margin, statics.rung()};
}

/// Chooses among contenders that first-order terms do not order: by the infinitesimal loads, or by name.
std::optional<Failure> choose(Statics& statics, const std::vector<Contender>& contenders, OpeningContest& contest,
                              OpeningRule rule, Minimum& minimum) {
    const auto members = choosable(contest, minimum);
    if (!members.ok()) {
        return members.failure();
    }
    const Contender& best = contenders[*minimum.index];
    if (members.value().empty()) {
        return failed(FailureKind::tie, "the opening rule cannot order the contacts {} (f = {:.17g}){}",
                      name(statics, best.contact), best.force.value, minimum.tied);
    }
    std::vector<Contender> again;
    for (const std::size_t k : members.value()) {
        const Enclosure f = statics.infinitesimal(contenders[k].contact);
        again.push_back({contenders[k].contact, f, f, infinity, 0});
    }
    const auto infinitesimal = [&](ContactId l) { return statics.infinitesimal_expression(l); };
    const Result<Opening> by_loads = pick(statics, again, Choice{rule, 0, infinitesimal, nullptr, nullptr});
    const ContactId first = by_loads.ok() ? by_loads.value().contact : pick_by_name(statics, again, 0).contact;
    const auto chosen = std::ranges::find_if(contenders, [first](const Contender& c) { return c.contact == first; });
    const auto index = static_cast<std::size_t>(chosen - contenders.begin());
    const auto record =
        recorded_choice(minimum, members.value(), index, by_loads.ok() ? TieChoice::loads : TieChoice::names);
    minimum.settled.insert(minimum.settled.end(), record.begin(), record.end());
    minimum.index = index;
    return std::nullopt;
}

} // namespace

Result<Opening> pick(Statics& statics, std::vector<Contender> contenders, const Choice& choice) {
    if (const auto place = rule_place(choice.rule, contenders.size(), choice.random_bits)) {
        return pick_by_name(statics, contenders, *place);
    }
    OpeningContest contest(statics, contenders, choice);
    const auto guess = std::ranges::min_element(
        contenders, [](const Contender& a, const Contender& b) { return a.key.value < b.key.value; });
    auto found = proved_minimum(contest, static_cast<std::size_t>(guess - contenders.begin()),
                                "the comparisons of the opening rule contradict each other");
    if (!found.ok()) {
        return found.failure();
    }
    Minimum& minimum = found.value();
    if (!minimum.tied.empty()) {
        if (auto failure = choose(statics, contenders, contest, choice.rule, minimum)) {
            return *failure;
        }
    }
    const Contender& best = contenders[*minimum.index];
    Opening opening{best.contact,
                    false,
                    best.force,
                    +1,
                    std::min(minimum.margin, best.margin),
                    std::max(minimum.rung, statics.rung())};
    opening.equal_forces = contest.equal_met();
    opening.perturbed = !minimum.settled.empty();
    if (choice.perturbed != nullptr) {
        std::vector<TieDecision>& log = choice.perturbed->log;
        log.insert(log.end(), minimum.settled.begin(), minimum.settled.end());
    }
    return opening;
}

} // namespace isostat
