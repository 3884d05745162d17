#pragma once
/// \file
/// The words of an enum: one array, in the order of its values, which count from 0.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace isostat {

template <std::size_t N> using EnumWords = std::array<const char*, N>;

/// \pre `words` has a word for each value.
template <class Enum, std::size_t N> constexpr const char* word_of(Enum value, const EnumWords<N>& words) {
    return words[static_cast<std::size_t>(value)];
}

/// The value of a word; nothing: `word` is not in `words`.
template <class Enum, std::size_t N>
constexpr std::optional<Enum> value_of(std::string_view word, const EnumWords<N>& words) {
    for (std::size_t k = 0; k < N; ++k) {
        if (word == words[k]) {
            return static_cast<Enum>(k);
        }
    }
    return std::nullopt;
}

/// "\"absent\", \"fixed\" or \"movable\"": for messages.
template <std::size_t N> std::string listed(const EnumWords<N>& words) {
    std::string text;
    for (std::size_t k = 0; k < N; ++k) {
        text += std::string(k == 0 ? "" : k + 1 < N ? ", " : " or ") + '"' + words[k] + '"';
    }
    return text;
}

} // namespace isostat
