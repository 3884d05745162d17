#pragma once
/// \file
/// What `inspect` says of a vertex at which more pairs touch than its contacts.

#include "io/json.hpp"

#include <isostat/contact/state.hpp>

namespace isostat::answers {

/// Of a state that a run left with pairs that touch besides its contacts: their names, and between which ends the
/// forces lie that are not unique. Of contacts that it left at force 0: their names. Nothing where it names none.
void print_face(std::string& out, const State& state);
/// `face`: `h`, `touching`, `self_stresses`, `forces_between`, or `undecided` with the reason; `left_at_zero`.
void add_face(json::Json& object, const State& state);

} // namespace isostat::answers
