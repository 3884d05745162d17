#pragma once
// The smallest of several quantities, proved: private to the room.

#include "statics/perturbed.hpp"

#include <isostat/core/result.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// What is proved of a rival against the smallest so far.
struct Comparison {
    enum class Answer : unsigned char { smaller, larger, tied, left_out };
    Answer answer = Answer::left_out; ///< the rival is ...; left out: it does not compete
    double margin = std::numeric_limits<double>::infinity();
    Rung rung = Rung::combinatorial; ///< that proved it
    Words tie;                       ///< with `tied`: who, and how far the two agree
    /// A tie in the base that first-order terms ordered; with `tied`: that they do not, and that may be chosen.
    std::optional<TieDecision> settled;
};

/// Quantities that can be compared, by number.
class Contest {
  public:
    Contest() = default;
    Contest(const Contest&) = delete;
    Contest& operator=(const Contest&) = delete;
    virtual ~Contest() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Before the others are compared with `best`. Another number: that one takes its place; none: there is no minimum.
    virtual Result<std::optional<std::size_t>> stand(std::size_t best) = 0;
    virtual Result<Comparison> compare(std::size_t rival, std::size_t best) = 0;
};

struct Minimum {
    /// Someone who cannot be told from it.
    struct Tied {
        std::size_t index;
        std::optional<TieDecision> terms;
    };
    std::optional<std::size_t> index; ///< none: as `Contest::stand` says
    Words tied;                       ///< not empty: these cannot be told from it
    std::vector<Tied> open;           ///< the same by number
    double margin = std::numeric_limits<double>::infinity();
    Rung rung = Rung::combinatorial;  ///< highest of the comparisons
    std::vector<TieDecision> settled; ///< first-order comparisons that were needed
};

/// The guess `first`, or whoever is proved smaller and takes its place, after a comparison with all others. Failure:
/// that of a comparison; `undecided` when they contradict each other (a place is lost more often than there are
/// contenders), with `contradiction`.
Result<Minimum> proved_minimum(Contest& contest, std::size_t first, const char* contradiction);

/// The answer of a proved comparison of the rival with the smallest so far; what `tie` returns is said of it when there
/// is none.
template <class MakeWords> Comparison by_order(const Order& order, const MakeWords& tie) {
    Comparison result;
    if (!order.decided || order.sign == 0) {
        result.answer = Comparison::Answer::tied;
        result.tie = tie();
    } else {
        result.answer = order.sign < 0 ? Comparison::Answer::smaller : Comparison::Answer::larger;
        result.margin = order.margin;
        result.rung = order.rung;
    }
    return result;
}

/// The base does not tell the two apart: `order` says that a quantity of this size is a tie.
bool needs_first_order(const Order& order, double size);

/// How first-order terms are compared, and what is said when they do not tell.
struct FirstOrderRule {
    bool falling = false; ///< the larger term is the smaller quantity
    bool choose = false;  ///< what they do not tell is tied, and may be chosen; else it is `undecided`
    Rung rung = Rung::none;
};

/// The rule of first order: `terms.other` is that of the rival, `terms.first` that of the smallest so far. Failure:
/// `undecided`, with `message` and the two terms.
Result<Comparison> by_first_order(TieDecision terms, const Order& order, const FirstOrderRule& rule,
                                  const Words& message);

/// Who may be chosen: the smallest and all that are tied with it, but for those proved larger than another of them.
/// Empty: not all of the ties may be. Failure: that of a comparison.
Result<std::vector<std::size_t>> choosable(Contest& contest, const Minimum& minimum);
/// The choice in records: against each other one of `members`, with what is known of them in the base.
std::vector<TieDecision> recorded_choice(const Minimum& minimum, const std::vector<std::size_t>& members,
                                         std::size_t chosen, TieChoice how);

/// "proved to 256 bits" or "exactly".
std::string reach(const Order& order);
/// "value +- radius", said of first-order terms.
std::string shown(const Enclosure& e);

} // namespace isostat
