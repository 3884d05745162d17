#pragma once
/// \file
/// The words of an enum: one for each of its enumerators, which count from 0.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace isostat {

/// Whether `value` has a name: compilers print "Enum::name" for an enumerator, and "(Enum)3" for another value.
template <auto value> constexpr bool is_enumerator() {
    const std::string_view printed = __PRETTY_FUNCTION__;
    return printed[printed.find_last_of(":)")] == ':';
}

/// Made by `words_of`, read by `word_of` and `value_of`.
template <class Enum, std::size_t N> class EnumWords {
  public:
    constexpr explicit EnumWords(const std::array<const char*, N>& words) : words_(words) {
        static_assert(is_enumerator<static_cast<Enum>(N - 1)>(), "more words than enumerators");
        static_assert(!is_enumerator<static_cast<Enum>(N)>(), "an enumerator without a word");
    }
    /// Throws `std::out_of_range` for a value that is no enumerator.
    [[nodiscard]] constexpr const char* at(std::size_t value) const { return words_.at(value); }
    [[nodiscard]] static constexpr std::size_t size() { return N; }
    [[nodiscard]] constexpr auto begin() const { return words_.begin(); }
    [[nodiscard]] constexpr auto end() const { return words_.end(); }

  private:
    std::array<const char*, N> words_;
};

/// `words` in the order of the enumerators, which have no gaps; another number of words than of enumerators does not
/// compile.
template <class Enum, class... Word> constexpr EnumWords<Enum, sizeof...(Word)> words_of(Word... words) {
    return EnumWords<Enum, sizeof...(Word)>({words...});
}

/// Throws `std::out_of_range` for a value that is no enumerator.
template <class Enum, std::size_t N> constexpr const char* word_of(Enum value, const EnumWords<Enum, N>& words) {
    return words.at(static_cast<std::size_t>(value));
}

/// The value of a word; nothing: `word` is not in `words`.
template <class Enum, std::size_t N>
constexpr std::optional<Enum> value_of(std::string_view word, const EnumWords<Enum, N>& words) {
    for (std::size_t k = 0; k < N; ++k) {
        if (word == words.at(k)) {
            return static_cast<Enum>(k);
        }
    }
    return std::nullopt;
}

/// "\"absent\", \"fixed\" or \"movable\"": for messages.
template <class Enum, std::size_t N> std::string listed(const EnumWords<Enum, N>& words) {
    std::string text;
    for (std::size_t k = 0; k < N; ++k) {
        text += std::string(k == 0 ? "" : k + 1 < N ? ", " : " or ") + '"' + words.at(k) + '"';
    }
    return text;
}

} // namespace isostat
