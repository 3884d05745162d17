#include "statics/proved_minimum.hpp"

#include "contact/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

/// Compares all with `best`, as far as somebody who is proved smaller.
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
        case Comparison::Answer::tied: minimum.tied += found.tie; break;
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

Comparison by_order(const Order& order, Words tie) {
    Comparison result;
    if (!order.decided || order.sign == 0) {
        result.answer = Comparison::Answer::tied;
        result.tie = std::move(tie);
    } else {
        result.answer = order.sign < 0 ? Comparison::Answer::smaller : Comparison::Answer::larger;
        result.margin = order.margin;
        result.rung = order.rung;
    }
    return result;
}

bool needs_first_order(const Order& order, double size) {
    return (!order.decided || order.sign == 0) && is_tie(order, size);
}

Result<Comparison> by_first_order(TieDecision terms, const Order& order, bool falling, Rung rung,
                                  const Words& message) {
    const Enclosure difference = falling ? terms.first - terms.other : terms.other - terms.first;
    if (!difference.decided()) {
        return failed(FailureKind::undecided, "tied at first order too: {} are {} and {}", message, shown(terms.first),
                      shown(terms.other));
    }
    terms.exponent = order.exponent;
    terms.bits = order.bits;
    Comparison result;
    result.answer = difference.negative() ? Comparison::Answer::smaller : Comparison::Answer::larger;
    result.margin = difference.margin();
    result.rung = rung;
    result.settled = std::move(terms);
    return result;
}

std::string reach(const Order& order) {
    return order.decided ? "they are exactly equal" : fmt::format("they agree to {} bits", order.bits);
}

std::string shown(const Enclosure& e) {
    return fmt::format("{:.6g} +- {:.3g}", e.value, e.radius);
}

} // namespace isostat
