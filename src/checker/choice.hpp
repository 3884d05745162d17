#pragma once
/// \file
/// Choices of a run under `ties = "choose"` (proofs/degenerate.md, C1; checker.md, K22).

#include "checker/replay.hpp"

#include <functional>

namespace isostat::checker {

/// How a run orders contacts that are tied.
struct ChoiceRule {
    std::string what;                       ///< "opening" or "limit"
    std::function<bool(std::size_t)> tied;  ///< not told apart from the chosen contact in the base
    std::function<Range(std::size_t)> load; ///< the smallest load opens first by the infinitesimal loads
};

/// The record of a choice of one contact against another; null: no record.
const TieRecord* recorded_choice(const std::vector<TieRecord>& ties, const std::string& what, const std::string& chosen,
                                 const std::string& against);

/// Checks a recorded choice of a contact: the other contacts are not refuted to be tied with it in the base
/// (`check_ties` checks the same at first order), and the rule takes it. Never proves that the contacts are tied.
Objections check_choice(const Place& place, const std::vector<TieRecord>& ties, std::size_t chosen,
                        const ChoiceRule& rule);

/// Checks an exchange of the list before `opened` opens, where a touching pair would overlap at second order, or rests
/// (C3, C5; K23): `place` has the list before the exchange.
Objections check_exchange(const Place& place, const TieRecord& tie, std::size_t opened);

/// Checks a pair that is assumed to keep touching when `opened` opens (C4; K25): neither the rate nor the second
/// derivative of its gap can be told from 0.
Objections check_rest(const Place& place, const TieRecord& tie, std::size_t opened, int direction);

} // namespace isostat::checker
