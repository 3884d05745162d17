#pragma once
// The true vertex, as the search compares with it: to 200 digits. The states here have condition numbers far below
// 1e40.

#include "oracle/truth.hpp"

namespace contradictions {

using namespace isostat;
using isostat::oracle::Real;
using isostat::oracle::sign_of;
using isostat::oracle::Truth;
using End = Truth::End;
using OtherPair = Truth::OtherPair;
using Vector = Truth::Vector;
inline const Real& negligible = isostat::oracle::negligible<Real>;

} // namespace contradictions
