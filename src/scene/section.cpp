#include "scene/section.hpp"

#include "io/text.hpp"
#include "scene/named_input.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace isostat {

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

std::string toml_text(double value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_text(const std::string& value) {
    // A basic string with the escapes that JSON has too, because records of a run contain this string.
    std::string quoted = "\"";
    for (const char c : value) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (code < 0x20 || code == 0x7f) {
            quoted += fmt::format("\\u{:04X}", code);
        } else {
            quoted += c;
        }
    }
    return text::json(quoted + "\"");
}

void Section::fail(const std::string& key, const std::string& expected) const {
    throw Error(ErrorKind::bad_input, fmt::format("{}:{}: {} in [{}] is {}: expected {}", source_, line_of(key), key,
                                                  name_, text_of(*table_->get(key)), expected));
}

void Section::refuse(const std::string& key, const std::string& what) const {
    throw Error(ErrorKind::bad_input, fmt::format("{}:{}: {}", source_, line_of(key), what));
}

int Section::line_of(const std::string& key) const {
    if (table_ == nullptr) {
        return 0;
    }
    const toml::node* node = table_->get(key);
    return line_of_node(node != nullptr ? *node : *table_);
}

const toml::node* Section::find(const std::string& key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        known_.push_back(key);
    }
    return table_ == nullptr ? nullptr : table_->get(key);
}

std::optional<double> Section::number(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_number()) {
        fail(key, "a number");
    }
    const double value = node->value<double>().value_or(std::nan(""));
    if (!std::isfinite(value)) {
        fail(key, "a finite number");
    }
    return value;
}

std::optional<long> Section::integer(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_integer()) {
        fail(key, "an integer");
    }
    return static_cast<long>(*node->value<std::int64_t>());
}

std::optional<bool> Section::boolean(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_boolean()) {
        fail(key, "true or false");
    }
    return node->value<bool>();
}

std::optional<std::string> Section::string(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_string()) {
        fail(key, "a string");
    }
    return node->value<std::string>();
}

std::optional<std::filesystem::path> Section::file(const std::string& key, const std::filesystem::path& folder) {
    const auto name = string(key);
    if (!name) {
        return std::nullopt;
    }
    return named_input(folder, *name, fmt::format("{}:{}: {} in [{}]", source_, line_of(key), key, name_));
}

std::optional<std::vector<double>> Section::numbers(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const toml::array* array = node->as_array();
    if (array == nullptr) {
        fail(key, "an array of numbers");
    }
    std::vector<double> values;
    for (const toml::node& element : *array) {
        const double value = element.is_number() ? element.value<double>().value_or(std::nan("")) : std::nan("");
        if (!std::isfinite(value)) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}:{}: {}[{}] in [{}] is {}: expected a finite number", source_,
                                    line_of_node(element), key, values.size(), name_, text_of(element)));
        }
        values.push_back(value);
    }
    return values;
}

const toml::table* Section::table(const std::string& key) {
    const toml::node* node = find(key);
    if (node != nullptr && node->as_table() == nullptr) {
        fail(key, "a table");
    }
    return node == nullptr ? nullptr : node->as_table();
}

double Section::number(const std::string& key, double fallback, double lowest, double highest,
                       const std::string& expected) {
    const double value = number(key).value_or(fallback);
    if (!(value >= lowest && value <= highest)) {
        fail(key, expected);
    }
    record(key, toml_text(value));
    return value;
}

long Section::integer(const std::string& key, long fallback, long lowest, long highest) {
    const long value = integer(key).value_or(fallback);
    if (value < lowest || value > highest) {
        fail(key, fmt::format("an integer from {} to {}", lowest, highest));
    }
    record(key, fmt::format("{}", value));
    return value;
}

bool Section::boolean(const std::string& key, bool fallback) {
    const bool value = boolean(key).value_or(fallback);
    record(key, value ? "true" : "false");
    return value;
}

std::size_t Section::word(const std::string& key, std::size_t fallback, const std::vector<std::string>& words) {
    const auto given = string(key);
    std::size_t index = fallback;
    if (given) {
        index = static_cast<std::size_t>(std::find(words.begin(), words.end(), *given) - words.begin());
        if (index == words.size()) {
            fail(key, fmt::format("one of \"{}\"", fmt::join(words, "\", \"")));
        }
    }
    record(key, toml_text(words[index]));
    return index;
}

void Section::record(const std::string& key, const std::string& value) {
    settings_->push_back({name_, key, value, has(key) ? line_of(key) : 0});
}

void Section::finish() const {
    if (table_ == nullptr) {
        return;
    }
    for (const auto& [key, node] : *table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) == known_.end()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}:{}: unknown key '{}' in [{}]: expected one of {}", source_,
                                    key.source().begin.line, key.str(), name_, fmt::join(known_, ", ")));
        }
    }
}

} // namespace isostat
