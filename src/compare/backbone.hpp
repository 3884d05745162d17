#pragma once
/// \file
/// A state without its rattlers.

#include <isostat/contact/state.hpp>

namespace isostat::compare {

/// The disks and movable walls that `carrying` holds, in these contacts, under the same load; infinitesimal loads are
/// generic ones of their own.
State<2> backbone_of(const State<2>& state, const std::vector<Contact>& carrying);

} // namespace isostat::compare
