#pragma once
// What a regular expression finds in a text.

#include "support/test.hpp"

#include <regex>

namespace program {

/// What the first group of a pattern matches: in the order of the text, or as a set.
template <class Words = std::vector<std::string>> Words matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return {std::sregex_token_iterator(text.begin(), text.end(), expression, 1), {}};
}

} // namespace program
