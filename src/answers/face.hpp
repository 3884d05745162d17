#pragma once
/// \file
/// The output of `inspect` for a vertex where more pairs touch than its contacts.

#include "io/json.hpp"

#include <isostat/contact/state.hpp>

namespace isostat::answers {

/// For a state that a run left with touching pairs besides its contacts: their names, and the ranges of forces that are
/// not unique. For contacts that the run left at force 0: their names. Nothing when the state names no such pair.
void print_face(std::string& out, const State& state);
/// `face`: `h`, `touching`, `self_stresses`, `forces_between`, or `undecided` with the reason; `left_at_zero`.
void add_face(json::Json& object, const State& state);

} // namespace isostat::answers
