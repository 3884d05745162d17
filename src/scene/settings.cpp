#include "scene/settings.hpp"

#include "io/section.hpp"

#include <fmt/format.h>

namespace isostat {

double SceneSection::number(const std::string& key, double fallback, double lowest, double highest,
                            const std::string& expected) {
    const double value = number(key).value_or(fallback);
    if (!(value >= lowest && value <= highest)) {
        fail(key, expected);
    }
    record(key, toml_text(value));
    return value;
}

long SceneSection::integer(const std::string& key, long fallback, long lowest, long highest) {
    const long value = integer(key).value_or(fallback);
    if (value < lowest || value > highest) {
        fail(key, "an integer from {} to {}", lowest, highest);
    }
    record(key, fmt::format("{}", value));
    return value;
}

bool SceneSection::boolean(const std::string& key, bool fallback) {
    const bool value = boolean(key).value_or(fallback);
    record(key, value ? "true" : "false");
    return value;
}

std::size_t SceneSection::word(const std::string& key, std::size_t fallback, const std::vector<std::string>& words) {
    const std::size_t index = place(key, fallback, words);
    record(key, toml_text(words[index]));
    return index;
}

void SceneSection::record(const std::string& key, const std::string& value) {
    settings_->push_back({name(), key, value, has(key) ? line_of(key) : 0});
}

} // namespace isostat
