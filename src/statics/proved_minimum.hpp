#pragma once
// The smallest of several quantities, proved: private to the room.

#include "statics/perturbed.hpp"

#include <isostat/core/result.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// What is proved about a rival and the smallest quantity so far.
struct Comparison {
    enum class Answer : unsigned char { smaller, larger, tied, left_out };
    Answer answer = Answer::left_out; ///< the rival is smaller, larger, tied; or is left out of the contest
    double margin = std::numeric_limits<double>::infinity();
    Rung rung = Rung::combinatorial; ///< arithmetic of the proof
    Words tie;                       ///< with `tied`: the two names, and how far they agree
    /// A tie in the base that first-order terms ordered; with `tied`: one that they leave open and that may be chosen.
    std::optional<TieDecision> settled;
};

/// Quantities that can be compared, known by their numbers.
class Contest {
  public:
    Contest() = default;
    Contest(const Contest&) = delete;
    Contest& operator=(const Contest&) = delete;
    virtual ~Contest() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Called before the others are compared with `best`. Returns another number to replace it; nothing: no minimum.
    virtual Result<std::optional<std::size_t>> stand(std::size_t best) = 0;
    virtual Result<Comparison> compare(std::size_t rival, std::size_t best) = 0;
};

struct Minimum {
    /// A quantity that cannot be told from the minimum.
    struct Tied {
        std::size_t index;
        std::optional<TieDecision> terms;
    };
    std::optional<std::size_t> index; ///< nothing: `Contest::stand` returned nothing
    Words tied;                       ///< not empty: names that cannot be told from the minimum
    std::vector<Tied> open;           ///< the same quantities by number
    double margin = std::numeric_limits<double>::infinity();
    Rung rung = Rung::combinatorial;  ///< highest rung of the comparisons
    std::vector<TieDecision> settled; ///< first-order comparisons that were needed
};

/// The guess `first`, or a quantity proved smaller that replaced it, after a comparison with all others. Failure: that
/// of a comparison; `undecided`, with `contradiction`, when comparisons contradict each other (the smallest was
/// replaced more often than there are quantities).
Result<Minimum> proved_minimum(Contest& contest, std::size_t first, const char* contradiction);

/// The result of a proved comparison of the rival with the smallest so
/// far; where `order` is undecided, a tie with the words from `tie`.
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

/// The two quantities are tied in the base: `order` says that a quantity of this size cannot be told from 0.
bool needs_first_order(const Order& order, double size);

/// How first-order terms are compared, and what follows when they leave a tie.
struct FirstOrderRule {
    bool falling = false; ///< the larger term is the smaller quantity
    bool choose = false;  ///< what they leave tied may be chosen; else it is `undecided`
    Rung rung = Rung::none;
};

/// The comparison at first order: `terms.other` is the term of the rival, `terms.first` that of the smallest so far.
/// Failure: `undecided`, with `message` and the two terms.
Result<Comparison> by_first_order(TieDecision terms, const Order& order, const FirstOrderRule& rule,
                                  const Words& message);

/// Quantities that may be chosen: the smallest and all that are tied with it, except those proved larger than another
/// one of them. Empty: a tie among them may not be chosen. Failure: that of a comparison.
Result<std::vector<std::size_t>> choosable(Contest& contest, const Minimum& minimum);
/// The choice as records show it: one entry against each other member, with what is known of the two in the base.
std::vector<TieDecision> recorded_choice(const Minimum& minimum, const std::vector<std::size_t>& members,
                                         std::size_t chosen, TieChoice how);

/// "proved to 256 bits" or "exactly".
std::string reach(const Order& order);
/// "value +- radius" of a first-order term.
std::string shown(const Enclosure& e);

} // namespace isostat
