#include "io/section.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace isostat {

namespace fs = std::filesystem;

namespace {

int line_of_node(const toml::node& node) {
    return static_cast<int>(node.source().begin.line);
}

std::string text_of(const toml::node& node) {
    constexpr std::size_t longest = 60;
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    std::string words = text.str();
    return words.size() > longest ? words.substr(0, longest) + "..." : words;
}

} // namespace

fs::path named_input(const fs::path& folder, const std::string& name, const std::string& where) {
    const auto refuse = [&](const char* why) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{} is \"{}\", {}: expected a regular file beside the file that names it, or below",
                                where, name, why));
    };
    const fs::path named = name;
    if (named.is_absolute() || std::ranges::find(named, "..") != named.end()) {
        refuse("which leads elsewhere");
    }
    fs::path path = folder / named;
    std::error_code absent;
    const fs::path real = fs::canonical(path, absent);
    if (absent) {
        return path;
    }
    const fs::path below = fs::canonical(folder.empty() ? fs::path(".") : folder);
    if (std::mismatch(below.begin(), below.end(), real.begin(), real.end()).first != below.end()) {
        refuse("a link that leads elsewhere");
    }
    if (!fs::is_regular_file(real) && !fs::is_directory(real)) { // the reader reports a folder
        refuse("a device or a pipe");
    }
    return path;
}

void Section::fail(const std::string& key, const std::string& expected) const {
    fail(*table_->get(key), key, expected);
}

void Section::fail(const toml::node& node, const std::string& key, const std::string& expected) const {
    fail_found(node, key, text_of(node), expected);
}

void Section::fail_found(const toml::node& node, const std::string& key, const std::string& found,
                         const std::string& expected) const {
    throw Error(ErrorKind::bad_input, fmt::format("{}:{}: {}{} is {}: expected {}", source_, line_of_node(node), key,
                                                  within(), found, expected));
}

void Section::refuse(const std::string& key, const std::string& what) const {
    throw Error(ErrorKind::bad_input, fmt::format("{}:{}: {}", source_, line_of(key), what));
}

int Section::line_of(const std::string& key) const {
    if (table_ == nullptr) {
        return 1; // the file's
    }
    const toml::node* node = table_->get(key);
    return std::max(line_of_node(node != nullptr ? *node : *table_), 1);
}

const toml::node* Section::node(const std::string& key) {
    if (std::ranges::find(known_, key) == known_.end()) {
        known_.push_back(key);
    }
    return table_ == nullptr ? nullptr : table_->get(key);
}

const toml::node& Section::required(const std::string& key, const std::string& expected) {
    const toml::node* found = node(key);
    if (found == nullptr) {
        refuse(key, fmt::format("no {}{}: expected {}", key, within(), expected));
    }
    return *found;
}

template <class Value> std::optional<Value> Section::value(const std::string& key, const char* expected) {
    const toml::node* found = node(key);
    if (found == nullptr) {
        return std::nullopt;
    }
    if (!found->is<Value>()) {
        fail(key, expected);
    }
    return found->value<Value>();
}

std::optional<double> Section::number(const std::string& key) {
    const toml::node* found = node(key);
    if (found == nullptr) {
        return std::nullopt;
    }
    if (!found->is_number()) {
        fail(key, "a number");
    }
    const double value = found->value<double>().value_or(std::nan(""));
    if (!std::isfinite(value)) {
        fail(key, "a finite number");
    }
    return value;
}

std::optional<long> Section::integer(const std::string& key) {
    return value<std::int64_t>(key, "an integer");
}

std::optional<bool> Section::boolean(const std::string& key) {
    return value<bool>(key, "true or false");
}

std::optional<std::string> Section::string(const std::string& key) {
    return value<std::string>(key, "a string");
}

std::optional<std::filesystem::path> Section::file(const std::string& key, const std::filesystem::path& folder) {
    const auto name = string(key);
    if (!name) {
        return std::nullopt;
    }
    return named_input(folder, *name, fmt::format("{}:{}: {}{}", source_, line_of(key), key, within()));
}

std::optional<std::vector<double>> Section::numbers(const std::string& key) {
    const toml::node* found = node(key);
    if (found == nullptr) {
        return std::nullopt;
    }
    if (!found->is_array()) {
        fail(key, "an array of numbers");
    }
    std::vector<double> values;
    for (const toml::node& element : *found->as_array()) {
        const double value = element.is_number() ? element.value<double>().value_or(std::nan("")) : std::nan("");
        if (!std::isfinite(value)) {
            fail(element, fmt::format("{}[{}]", key, values.size()), "a finite number");
        }
        values.push_back(value);
    }
    return values;
}

const toml::table* Section::table(const std::string& key) {
    const toml::node* found = node(key);
    return found == nullptr ? nullptr : &table(*found, key);
}

const toml::array* Section::array(const std::string& key, std::size_t size) {
    const toml::node* found = node(key);
    return found == nullptr ? nullptr : &array(*found, key, size);
}

const toml::table& Section::table(const toml::node& node, const std::string& key) const {
    if (!node.is_table()) {
        fail(node, key, "a table");
    }
    return *node.as_table();
}

const toml::array& Section::array(const toml::node& node, const std::string& key, std::size_t size) const {
    if (!node.is_array() || (size != 0 && node.as_array()->size() != size)) {
        fail(node, key, size == 0 ? "an array" : fmt::format("an array of {}", size));
    }
    return *node.as_array();
}

std::size_t Section::place(const std::string& key, std::size_t fallback, const std::vector<std::string>& words) {
    const auto given = string(key);
    const auto at = given ? std::ranges::find(words, *given) - words.begin() : static_cast<long>(fallback);
    if (static_cast<std::size_t>(at) == words.size()) {
        fail(key, fmt::format("one of \"{}\"", fmt::join(words, "\", \"")));
    }
    return static_cast<std::size_t>(at);
}

void Section::finish() const {
    if (table_ == nullptr) {
        return;
    }
    for (const auto& [key, node] : *table_) {
        if (std::ranges::find(known_, key.str()) == known_.end()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}:{}: unknown key '{}'{}: expected one of {}", source_, key.source().begin.line,
                                    key.str(), within(), fmt::join(known_, ", ")));
        }
    }
}

} // namespace isostat
