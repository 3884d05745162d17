#pragma once
/// \file
/// JSON with messages that name file and field. The only place, with the .cpp files that include it, that knows the
/// JSON library.

#include "core/refuse.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/rigidity/counting.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace isostat::json {

using Json = nlohmann::ordered_json;

/// A value of a document together with where it is: "state.json: load.stress[1]".
class Field {
  public:
    /// Parses the whole text; a byte order mark is skipped. Throws `Error(bad_input)` with the line when it is not one
    /// complete JSON document, with the name when a field comes twice in one object, and when objects and arrays are
    /// nested deeper than 64 levels (functions that walk a document call themselves).
    static Json parse(const std::string& text, const std::string& source);

    Field(const Json& value, std::string source, std::string path = "")
        : value_(&value), source_(std::move(source)), path_(std::move(path)) {}

    /// Throws `Error(bad_input)`: "FILE: PATH is VALUE: expected WHAT".
    [[noreturn]] void fail(const std::string& expected) const;
    template <class... Values>
    [[noreturn]] void fail(fmt::format_string<Values...> expected, Values&&... values) const {
        fail(fmt::format(expected, std::forward<Values>(values)...));
    }

    /// "FILE: PATH".
    [[nodiscard]] std::string where() const { return source_ + ": " + path_; }
    /// Every key must be in the list.
    void only(const std::vector<std::string>& keys) const;
    [[nodiscard]] bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
    /// Member of an object. Throws when this is no object or the key is missing.
    [[nodiscard]] Field at(const char* key) const;
    /// Element of an array. \pre index < size().
    [[nodiscard]] Field at(std::size_t index) const;
    /// Length of an array. Throws when this is no array.
    [[nodiscard]] std::size_t size() const;
    /// The same, and it must be `expected`.
    void require_size(std::size_t expected, const std::string& what) const;
    /// The numbers of an array, and of one with `expected` elements.
    [[nodiscard]] std::vector<double> numbers() const;
    [[nodiscard]] std::vector<double> numbers(std::size_t expected, const std::string& what) const;

    /// A finite number, or a string with a hexadecimal float.
    [[nodiscard]] double number() const;
    [[nodiscard]] long integer() const;
    /// The same, from `lowest` to `highest`.
    [[nodiscard]] int integer(int lowest, int highest) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] const std::string& string() const;
    /// A value by its word.
    template <class Enum, std::size_t N> [[nodiscard]] Enum word(const EnumWords<Enum, N>& words) const {
        const std::optional<Enum> value = value_of(string(), words);
        if (!value) {
            fail(listed(words));
        }
        return *value;
    }
    [[nodiscard]] const Json& value() const { return *value_; }

  private:
    const Json* value_;
    std::string source_;
    std::string path_;
};

/// The text of a document. Bytes of its strings that are not UTF-8 (names of files may have some) become U+FFFD.
std::string dumped(const Json& document, int indent = -1);

/// A number for a record: infinities and NaN, which JSON does not have, become null.
Json or_null(double value);

/// The array of `make(element)` for the elements of a range.
template <class Range, class Make> Json array_of(const Range& range, Make make) {
    Json out = Json::array();
    for (const auto& element : range) {
        out.push_back(make(element));
    }
    return out;
}

/// N_f, N, rank, h and k of a list; and those for each way to strain a cell, by its word.
Json counts(const Counting& counting);
Json counts(const StrainCounts& of_strains);

/// Appends a finite number as `Json(value).dump()` writes it, without a document between.
void append_number(std::string& text, double value);

/// Appends "name": [ rows ] with one row per line, so that a state can be read and compared by people; `row(text, i)`
/// appends row i.
template <class Row> void append_rows(std::string& text, const char* name, std::size_t count, Row row) {
    text.append("  \"").append(name).append("\": [");
    for (std::size_t i = 0; i < count; ++i) {
        text += i == 0 ? "\n    " : ",\n    ";
        row(text, i);
    }
    text += count == 0 ? "]" : "\n  ]";
}

} // namespace isostat::json
