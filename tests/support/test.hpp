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

/// What is there; the test ends, with the message of a failure, where nothing is.
template <class T> T required(isostat::Result<T> result) {
    BOOST_REQUIRE_MESSAGE(result.ok(), (result.ok() ? std::string() : result.failure().message()));
    return std::move(result.value());
}

template <class T> T required(std::optional<T> value) {
    BOOST_REQUIRE(value.has_value());
    return std::move(*value);
}

/// There is a failure of this kind, whose message has these words.
inline isostat::Failure fails(const std::optional<isostat::Failure>& failure, isostat::FailureKind kind,
                              const std::vector<std::string>& words = {}) {
    const std::string message = required(failure).message();
    BOOST_TEST((failure->kind == kind), message);
    for (const std::string& word : words) {
        BOOST_TEST(message.find(word) != std::string::npos, "'" << word << "' is not in: " << message);
    }
    return *failure;
}

template <class T>
isostat::Failure fails(const isostat::Result<T>& result, isostat::FailureKind kind,
                       const std::vector<std::string>& words = {}) {
    return fails(result.ok() ? std::nullopt : std::optional(result.failure()), kind, words);
}
