#pragma once
// How many random trials: a number in the test, times ISOSTAT_TEST_SCALE.

#include "support/test.hpp"

#include <stdexcept>

namespace isostat::testing {

/// `count` times the environment variable ISOSTAT_TEST_SCALE, a whole number from 1 to 10 000; unset: 1. Seeds stay.
inline int scaled(int count) {
    const char* const text = std::getenv("ISOSTAT_TEST_SCALE"); // NOLINT(concurrency-mt-unsafe): nobody sets it
    if (text == nullptr) {
        return count;
    }
    char* end = nullptr;
    const long scale = std::strtol(text, &end, 10);
    if (end == text || *end != '\0' || scale < 1 || scale > 10'000) {
        throw std::runtime_error("ISOSTAT_TEST_SCALE is '" + std::string(text) +
                                 "': expected a whole number from 1 to 10000");
    }
    return count * static_cast<int>(scale);
}

} // namespace isostat::testing
