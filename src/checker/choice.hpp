#pragma once
/// \file
/// Choices of a run under `ties = "choose"` (proofs/degenerate.md, C1; checker.md, K22).

#include "checker/replay.hpp"

#include <functional>

namespace isostat::checker {

/// How a run orders contacts that it finds tied.
struct ChoiceRule {
    std::string what;                       ///< "opening" or "limit"
    std::function<bool(std::size_t)> tied;  ///< not told apart from the chosen contact in the base
    std::function<Range(std::size_t)> load; ///< the infinitesimal loads take the smallest
};

/// The record of a choice of one contact against another; null: there is none.
const TieRecord* recorded_choice(const std::vector<TieRecord>& ties, const std::string& what, const std::string& chosen,
                                 const std::string& against);

/// What the records say of the choice of that contact: that the others are not refuted to be tied with it in the base
/// (`check_ties` asks the same at first order), and that the rule takes it. Never that they are equal.
Objections check_choice(const Place& place, const std::vector<TieRecord>& ties, std::size_t chosen,
                        const ChoiceRule& rule);

/// An exchange of the list before `opened` opens, where a pair that touches would overlap at second order, or rests
/// (C3, C5; K23): `place` has the list before it.
Objections check_exchange(const Place& place, const TieRecord& tie, std::size_t opened);

/// A pair that is taken to keep touching when `opened` opens (C4; K25): neither rate nor second derivative of its gap
/// is told from 0.
Objections check_rest(const Place& place, const TieRecord& tie, std::size_t opened, int direction);

} // namespace isostat::checker
