#include "statics/proved_minimum.hpp"

#include "contact/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

/// Compares all with `best`, until one is proved smaller.
Result<std::optional<std::size_t>> pass(Contest& contest, std::size_t best, Minimum& minimum) {
    for (std::size_t rival = 0; rival < contest.size(); ++rival) {
        if (rival == best) {
            continue;
        }
        auto compared = contest.compare(rival, best);
        if (!compared.ok()) {
            return compared.failure();
        }
        Comparison& found = compared.value();
        switch (found.answer) {
        case Comparison::Answer::smaller: return std::optional(rival);
        case Comparison::Answer::left_out: break;
        case Comparison::Answer::tied:
            minimum.tied += found.tie;
            minimum.open.push_back({rival, std::move(found.settled)});
            break;
        case Comparison::Answer::larger:
            minimum.margin = std::min(minimum.margin, found.margin);
            minimum.rung = std::max(minimum.rung, found.rung);
            if (found.settled) {
                minimum.settled.push_back(std::move(*found.settled));
            }
            break;
        }
    }
    return std::optional<std::size_t>();
}

} // namespace

Result<Minimum> proved_minimum(Contest& contest, std::size_t first, const char* contradiction) {
    std::size_t best = first;
    for (std::size_t restart = 0; restart <= contest.size(); ++restart) {
        const auto stands = contest.stand(best);
        if (!stands.ok()) {
            return stands.failure();
        }
        if (!stands.value()) {
            return Minimum{};
        }
        if (*stands.value() != best) {
            best = *stands.value();
            continue;
        }
        Minimum minimum;
        minimum.index = best;
        const auto smaller = pass(contest, best, minimum);
        if (!smaller.ok()) {
            return smaller.failure();
        }
        if (!smaller.value()) {
            return minimum;
        }
        best = *smaller.value();
    }
    return Failure{FailureKind::undecided, contradiction};
}

bool needs_first_order(const Order& order, double size) {
    return (!order.decided || order.sign == 0) && is_tie(order, size);
}

Result<Comparison> by_first_order(TieDecision terms, const Order& order, const FirstOrderRule& rule,
                                  const Words& message) {
    const Enclosure difference = rule.falling ? terms.first - terms.other : terms.other - terms.first;
    terms.exponent = order.exponent;
    terms.bits = order.bits;
    Comparison result;
    if (difference.decided()) {
        result.answer = difference.negative() ? Comparison::Answer::smaller : Comparison::Answer::larger;
        result.margin = difference.margin();
        result.rung = rule.rung;
    } else {
        const Words tie =
            words("tied at first order too: {} are {} and {}", message, shown(terms.first), shown(terms.other));
        if (!rule.choose) {
            return Failure{FailureKind::undecided, tie};
        }
        result.answer = Comparison::Answer::tied;
        result.tie = tie;
    }
    result.settled = std::move(terms);
    return result;
}

Result<std::vector<std::size_t>> choosable(Contest& contest, const Minimum& minimum) {
    std::vector<std::size_t> members{*minimum.index};
    for (const Minimum::Tied& one : minimum.open) {
        if (!one.terms) {
            return std::vector<std::size_t>();
        }
        bool first = true;
        for (const Minimum::Tied& other : minimum.open) {
            if (!first || &other == &one) {
                continue;
            }
            const auto compared = contest.compare(one.index, other.index);
            if (!compared.ok()) {
                return compared.failure();
            }
            first = compared.value().answer != Comparison::Answer::larger;
        }
        if (first) {
            members.push_back(one.index);
        }
    }
    return members;
}

std::vector<TieDecision> recorded_choice(const Minimum& minimum, const std::vector<std::size_t>& members,
                                         std::size_t chosen, TieChoice how) {
    const auto tie = [&](std::size_t member) -> const TieDecision& { // of the smallest with this one
        return *std::ranges::find_if(minimum.open, [member](const Minimum::Tied& one) {
                    return one.index == member;
                })->terms;
    };
    std::vector<TieDecision> record;
    for (const std::size_t member : members) {
        if (member == chosen) {
            continue;
        }
        TieDecision entry = tie(member == *minimum.index ? chosen : member);
        if (member == *minimum.index) {
            std::swap(entry.chosen, entry.against);
            std::swap(entry.first, entry.other);
        } else if (chosen != *minimum.index) {
            const TieDecision& mine = tie(chosen);
            entry.chosen = mine.against;
            entry.first = mine.other;
            entry.exponent = std::max(entry.exponent, mine.exponent) + 1; // |x - y| <= |x - z| + |z - y|
        }
        entry.choice = how;
        record.push_back(std::move(entry));
    }
    return record;
}

std::string reach(const Order& order) {
    return order.decided ? "they are exactly equal" : fmt::format("they agree to {} bits", order.bits);
}

std::string shown(const Enclosure& e) {
    return fmt::format("{:.6g} +- {:.3g}", e.value, e.radius);
}

} // namespace isostat
