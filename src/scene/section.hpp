#pragma once
/// \file
/// One table of a scene file. A key becomes known when it is read; a key of the file that was never read is an error.
/// So the list of known keys, the defaults and the output of `plan` cannot disagree.

#include <isostat/scene/scene.hpp>

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

class Section {
  public:
    /// `table` may be null: all defaults.
    Section(const toml::table* table, std::string name, std::string source, std::vector<Setting>& settings)
        : table_(table), name_(std::move(name)), source_(std::move(source)), settings_(&settings) {}

    /// Throws `Error(bad_input)`: "FILE:LINE: KEY is VALUE: expected WHAT".
    [[noreturn]] void fail(const std::string& key, const std::string& expected) const;
    /// The same without a value: "FILE:LINE: WHAT", at the line of the key (or of the table when the key is absent).
    [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

    [[nodiscard]] bool has(const std::string& key) const { return table_ != nullptr && table_->contains(key); }
    [[nodiscard]] int line_of(const std::string& key) const;

    /// Each `get` returns the value or nothing when the key is absent, and throws for another type or a value that is
    /// not finite.
    std::optional<double> number(const std::string& key);
    std::optional<long> integer(const std::string& key);
    std::optional<bool> boolean(const std::string& key);
    std::optional<std::string> string(const std::string& key);
    /// A file in `folder` or below: see `named_input`.
    std::optional<std::filesystem::path> file(const std::string& key, const std::filesystem::path& folder);
    std::optional<std::vector<double>> numbers(const std::string& key);
    /// A table in this one; null when it is absent.
    const toml::table* table(const std::string& key);

    /// Values with defaults, which are recorded as settings.
    double number(const std::string& key, double fallback, double lowest, double highest, const std::string& expected);
    long integer(const std::string& key, long fallback, long lowest, long highest);
    bool boolean(const std::string& key, bool fallback);
    /// Index of the word in `words`.
    std::size_t word(const std::string& key, std::size_t fallback, const std::vector<std::string>& words);

    /// Records a setting that the caller read itself.
    void record(const std::string& key, const std::string& value);
    /// Throws for the first key that was never read.
    void finish() const;

  private:
    const toml::node* find(const std::string& key);
    const toml::table* table_;
    std::string name_, source_;
    std::vector<Setting>* settings_;
    std::vector<std::string> known_;
};

/// A value as TOML text.
std::string toml_text(double value);
std::string toml_text(const std::string& value);

} // namespace isostat
