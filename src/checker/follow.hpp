#pragma once
/// \file
/// Where an arc leads, approximately. Nothing of it is trusted: the end is proved to be a vertex afterwards.

#include "checker/problem.hpp"

#include <optional>

namespace isostat::checker {

/// Opens contact `opened` of a vertex, keeps the others closed and follows the motion until `closed` touches; then
/// solves for the vertex where `closed` has taken the place of `opened`. `distance` is about how far the fastest
/// coordinate moves (the record's). Nothing when the iteration fails.
std::optional<std::vector<double>> follow(const State<2>& from, std::size_t opened, const Contact& closed,
                                          double distance);

} // namespace isostat::checker
