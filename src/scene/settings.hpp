#pragma once
/// \file
/// A section of a scene: values have defaults, and what is used is recorded, so that the output of `plan` cannot
/// disagree with what was read.

#include "io/section.hpp"

#include <isostat/scene/scene.hpp>

#include <string>
#include <vector>

namespace isostat {

class SceneSection : public Section {
  public:
    SceneSection(const toml::table* table, const std::string& name, const std::string& source,
                 std::vector<Setting>& settings)
        : Section(table, name, source), settings_(&settings) {}

    using Section::boolean;
    using Section::integer;
    using Section::number;
    double number(const std::string& key, double fallback, double lowest, double highest, const std::string& expected);
    long integer(const std::string& key, long fallback, long lowest, long highest);
    bool boolean(const std::string& key, bool fallback);
    /// Index of the word in `words`.
    std::size_t word(const std::string& key, std::size_t fallback, const std::vector<std::string>& words);
    template <class Enum, std::size_t N>
    Enum word(const std::string& key, Enum fallback, const EnumWords<Enum, N>& words) {
        return static_cast<Enum>(word(key, static_cast<std::size_t>(fallback), {words.begin(), words.end()}));
    }

    /// Records a setting that the caller read itself.
    void record(const std::string& key, const std::string& value);

  private:
    std::vector<Setting>* settings_;
};

} // namespace isostat
