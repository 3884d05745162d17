#pragma once
/// \file
/// TOML documents: scenes and crafted packings. One table of a TOML file, and files that are named in other files. A
/// key becomes known when it is read; a key of the file that was never read is an error. So the list of known keys
/// cannot disagree with what is read.

#include "core/refuse.hpp"

#include <isostat/core/result.hpp>

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isostat {

/// Parses a document. Throws `Error(bad_input)` with the line when it is not valid TOML, or when a dotted name
/// ("a.b.c", also of a table) has more than 64 parts: each part is a table in a table, and functions that walk a
/// document call themselves (the library has a limit for nested values only, 256). \pre no byte order mark: positions
/// in the document are those of the text.
toml::table parse_toml(std::string_view text, const std::string& source);

/// A value as TOML text.
std::string toml_text(double value);
std::string toml_text(const std::string& value);

/// Where the parser's positions are in the text: lines and columns from 1, columns in code points.
class TomlLines {
  public:
    explicit TomlLines(std::string_view text);
    /// In bytes.
    [[nodiscard]] std::size_t offset(const toml::source_position& position) const;
    [[nodiscard]] std::string slice(const toml::source_region& region) const;

  private:
    std::string text_;
    std::vector<std::size_t> begin_; ///< of the lines
};

class Section {
  public:
    /// `table` may be null: no key is there. An empty `name`: the table is the whole file.
    Section(const toml::table* table, std::string name, std::string source)
        : table_(table), name_(std::move(name)), source_(std::move(source)) {}

    /// Throws `Error(bad_input)`: "FILE:LINE: KEY in [NAME] is VALUE: expected WHAT".
    [[noreturn]] void fail(const std::string& key, const std::string& expected) const;
    template <class... Values>
    [[noreturn]] void fail(const std::string& key, fmt::format_string<Values...> expected, Values&&... values) const {
        fail(key, fmt::format(expected, std::forward<Values>(values)...));
    }
    /// The same of a node in the value of the key, at its line.
    [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& expected) const;
    template <class... Values>
    [[noreturn]] void fail(const toml::node& node, const std::string& key, fmt::format_string<Values...> expected,
                           Values&&... values) const {
        fail(node, key, fmt::format(expected, std::forward<Values>(values)...));
    }
    /// The same with what was found there in the place of the text of the node.
    [[noreturn]] void fail_found(const toml::node& node, const std::string& key, const std::string& found,
                                 const std::string& expected) const;
    /// The same without a value: "FILE:LINE: WHAT", at the line of the key (or of the table when the key is absent).
    [[noreturn]] void refuse(const std::string& key, const std::string& what) const;
    template <class... Values>
    [[noreturn]] void refuse(const std::string& key, fmt::format_string<Values...> what, Values&&... values) const {
        refuse(key, fmt::format(what, std::forward<Values>(values)...));
    }

    [[nodiscard]] bool has(const std::string& key) const { return table_ != nullptr && table_->contains(key); }
    [[nodiscard]] int line_of(const std::string& key) const;

    /// Each of these returns the value, or nothing when the key is absent, and throws for another type or a number that
    /// is not finite.
    std::optional<double> number(const std::string& key);
    std::optional<long> integer(const std::string& key);
    std::optional<bool> boolean(const std::string& key);
    std::optional<std::string> string(const std::string& key);
    /// A file in `folder` or below: see `named_input`.
    std::optional<std::filesystem::path> file(const std::string& key, const std::filesystem::path& folder);
    std::optional<std::vector<double>> numbers(const std::string& key);
    /// The value of a word, `fallback` when the key is absent.
    template <class Enum, std::size_t N>
    Enum word(const std::string& key, Enum fallback, const EnumWords<Enum, N>& words) {
        return static_cast<Enum>(place(key, static_cast<std::size_t>(fallback), {words.begin(), words.end()}));
    }
    /// A table in this one, an array, a value of any type; null when it is absent.
    const toml::table* table(const std::string& key);
    const toml::array* array(const std::string& key, std::size_t size = 0);
    const toml::node* node(const std::string& key);
    /// The value of a key that must be there. Throws: "FILE:LINE: no KEY in [NAME]: expected WHAT".
    const toml::node& required(const std::string& key, const std::string& expected);

    /// A node as a table or an array, of `size` values unless `size` is 0.
    [[nodiscard]] const toml::table& table(const toml::node& node, const std::string& key) const;
    [[nodiscard]] const toml::array& array(const toml::node& node, const std::string& key, std::size_t size = 0) const;

    /// Throws for the first key that was never read.
    void finish() const;

  protected:
    /// Index of the word in `words`; `fallback` when the key is absent.
    std::size_t place(const std::string& key, std::size_t fallback, const std::vector<std::string>& words);
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    [[nodiscard]] std::string within() const { return name_.empty() ? "" : " in [" + name_ + "]"; }
    template <class Value> std::optional<Value> value(const std::string& key, const char* expected);
    const toml::table* table_;
    std::string name_, source_;
    std::vector<std::string> known_;
};

/// The file that a file in `folder` names, beside or below it. Throws `Error(bad_input)`, beginning with `where`, for a
/// name that leads elsewhere (absolute, with "..", through a link) and for a file that is not regular, because a device
/// or a pipe may never end. The reader reports a missing file. An empty `folder` is the current one.
std::filesystem::path named_input(const std::filesystem::path& folder, const std::string& name,
                                  const std::string& where);

} // namespace isostat
