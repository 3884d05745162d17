#include "io/json.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

namespace isostat::json {

namespace {

std::string shortened(const Json& value) {
    constexpr std::size_t longest = 60;
    std::string text = value.dump();
    if (text.size() > longest) {
        text = text.substr(0, longest) + "...";
    }
    return text;
}

constexpr int deepest = 64;

/// "0x1.8p+3" or "-0x1p-2", whole string.
bool parse_hexadecimal(const std::string& text, double& value) {
    const bool negative = text.starts_with("-");
    const std::size_t begin = negative ? 1 : 0;
    if (text.compare(begin, 2, "0x") != 0) {
        return false;
    }
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + begin + 2, end, value, std::chars_format::hex);
    value = negative ? -value : value;
    return error == std::errc() && stop == end && std::isfinite(value);
}

} // namespace

Json Field::parse(const std::string& text, const std::string& source) {
    require_floating_point(); // the library behind reads numbers as the C library does, which rounds as it is told
    const auto line_of = [&](std::size_t at) {
        return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    };
    if (const std::size_t at = text.find('\0'); at != std::string::npos) { // the parser would stop there
        refuse(ErrorKind::bad_input, "{}:{}: a byte 0: expected text", source, line_of(at));
    }
    std::vector<std::set<std::string>> open; // names of the fields of the objects that are not complete yet
    const Json::parser_callback_t watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > deepest) {
            refuse(ErrorKind::bad_input, "{}: objects and arrays are nested deeper than {} levels: expected fewer",
                   source, deepest);
        }
        if (event == Json::parse_event_t::object_start) {
            open.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            open.pop_back();
        } else if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second) {
            refuse(ErrorKind::bad_input, "{}: the field '{}' comes twice in one object: expected once", source,
                   parsed.get<std::string>());
        }
        return true;
    };
    try {
        return Json::parse(text, watch);
    } catch (const nlohmann::json::parse_error& error) {
        const std::size_t at = std::min(error.byte, text.size());
        refuse(ErrorKind::bad_input, "{}:{}: {}", source, line_of(at),
               at >= text.size() ? "the file ends before its JSON document is complete: truncated?"
                                 : "not valid JSON here: expected a complete JSON document");
    } catch (const nlohmann::json::exception& error) {
        refuse(ErrorKind::bad_input, "{}: a number is out of the range of double ({})", source, error.what());
    }
}

void Field::fail(const std::string& expected) const {
    refuse(ErrorKind::bad_input, "{}: {} is {}: expected {}", source_, path_.empty() ? "the document" : path_,
           shortened(*value_), expected);
}

void Field::only(const std::vector<std::string>& keys) const {
    if (!value_->is_object()) {
        fail("an object");
    }
    for (const auto& [key, unused] : value_->items()) {
        if (std::ranges::find(keys, key) == keys.end()) {
            refuse(ErrorKind::bad_input, "{}: unknown field '{}'{}: expected one of {}", source_, key,
                   path_.empty() ? "" : " in " + path_, fmt::join(keys, ", "));
        }
    }
}

Field Field::at(const char* key) const {
    if (!value_->is_object()) {
        fail(fmt::format("an object with the field '{}'", key));
    }
    const auto found = value_->find(key);
    if (found == value_->end()) {
        refuse(ErrorKind::bad_input, "{}: the field '{}{}{}' is missing", source_, path_, path_.empty() ? "" : ".",
               key);
    }
    return {*found, source_, path_.empty() ? std::string(key) : path_ + "." + key};
}

Field Field::at(std::size_t index) const {
    return {(*value_)[index], source_, fmt::format("{}[{}]", path_, index)};
}

std::size_t Field::size() const {
    if (!value_->is_array()) {
        fail("an array");
    }
    return value_->size();
}

void Field::require_size(std::size_t expected, const std::string& what) const {
    if (size() != expected) {
        fail(fmt::format("{} ({} values, {} found)", what, expected, value_->size()));
    }
}

std::vector<double> Field::numbers() const {
    std::vector<double> all;
    all.reserve(size());
    for (std::size_t k = 0; k < size(); ++k) {
        all.push_back(at(k).number());
    }
    return all;
}

std::vector<double> Field::numbers(std::size_t expected, const std::string& what) const {
    require_size(expected, what);
    return numbers();
}

double Field::number() const {
    if (value_->is_number()) {
        const double number = value_->get<double>();
        if (!std::isfinite(number)) {
            fail("a finite number");
        }
        return number;
    }
    double number = 0;
    if (!value_->is_string() || !parse_hexadecimal(value_->get_ref<const std::string&>(), number)) {
        fail("a finite number");
    }
    return number;
}

long Field::integer() const {
    constexpr auto largest = std::numeric_limits<long>::max();
    if (!value_->is_number_integer() ||
        (value_->is_number_unsigned() && value_->get<unsigned long>() > static_cast<unsigned long>(largest))) {
        fail("an integer");
    }
    return value_->get<long>();
}

int Field::integer(int lowest, int highest) const {
    const long value = integer();
    if (value < lowest || value > highest) {
        fail(fmt::format("an integer from {} to {}", lowest, highest));
    }
    return static_cast<int>(value);
}

bool Field::boolean() const {
    if (!value_->is_boolean()) {
        fail("true or false");
    }
    return value_->get<bool>();
}

const std::string& Field::string() const {
    if (!value_->is_string()) {
        fail("a string");
    }
    return value_->get_ref<const std::string&>();
}

std::string dumped(const Json& document, int indent) {
    return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json counts(const Counting& c) {
    return {{"N_f", c.dof_count},    {"N", c.contact_count}, {"rank", c.rank}, {"rank_exact", to_string(c.rank_exact)},
            {"h", c.hyperstaticity}, {"k", c.mechanisms}};
}

Json counts(const StrainCounts& of_strains) {
    Json out;
    for (std::size_t k = 0; k < strains.size(); ++k) {
        out[to_string(strains[k])] = counts(of_strains[k]);
    }
    return out;
}

void append_number(std::string& text, double value) {
    std::array<char, 64> digits{};
    text.append(digits.data(), nlohmann::detail::to_chars(digits.data(), digits.data() + digits.size(), value));
}

} // namespace isostat::json
