#pragma once
// What most tests begin with, precompiled.

#include <isostat/core/result.hpp>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// The value of a result; the test ends with the message of a failure.
template <class T> T required(isostat::Result<T> result) {
    BOOST_REQUIRE_MESSAGE(result.ok(), (result.ok() ? std::string() : result.failure().message()));
    return std::move(result.value());
}
