#pragma once
/// \file
/// What a command answers, made once: the lines for people and the values for programs stand side by side.

#include "io/json.hpp"
#include "io/text.hpp"

#include <cstddef>
#include <string>
#include <utility>

namespace isostat::answers {

using json::Json;
using json::or_null;
using text::say;

/// Text and JSON object of an answer. Each function that adds to an answer adds to both under one condition.
struct Answer {
    std::size_t width = 24; ///< of the labels that begin the lines
    bool lists = true;      ///< false: long lists of values, which take time and have no words, are left out
    std::string text{};
    Json json = Json::object();

    /// For people alone: a line "label words".
    template <class... Values>
    void line(const std::string& label, fmt::format_string<Values...> words, Values&&... values) {
        say(text, "{:<{}} {}\n", label, width, fmt::vformat(words, fmt::make_format_args(values...)));
    }
    /// For programs alone.
    void item(const std::string& key, Json value) { json[key] = std::move(value); }
    /// For both: `key` has the value, and a line "label words" says it.
    template <class... Values>
    void item(const std::string& key, Json value, const std::string& label, fmt::format_string<Values...> words,
              Values&&... values) {
        item(key, std::move(value));
        line(label, words, std::forward<Values>(values)...);
    }
    /// For both, a value that is its own words.
    template <class Value> void same(const std::string& key, const std::string& label, const Value& value) {
        item(key, value, label, "{}", value);
    }
    /// Appends the lines of a part; its object becomes the value of `key`.
    void part(const std::string& key, Answer other) {
        text += other.text;
        item(key, std::move(other.json));
    }
};

} // namespace isostat::answers
