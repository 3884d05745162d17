#pragma once
/// \file
/// A section of a scene: values have defaults, and what is used is recorded, so that the output of `plan` cannot
/// disagree with what was read. Radii of a scene: from a text file, or drawn as the keys of [packing] say.

#include "io/section.hpp"

#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>

#include <filesystem>
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

/// Smallest radius or diameter for a preparation; the largest is such that a box of many stays below `longest_length`.
inline constexpr double smallest_size = 1e-140;
inline constexpr double largest_size = 1e140;

/// One radius per line; '#' starts a comment line. Throws `Error(bad_input)` with file and line.
std::vector<double> read_radii(const std::filesystem::path& path);

/// The law, with its defaults recorded. Throws `Error(bad_input)`
/// for keys of another law and for a law with a fault.
DiameterLaw read_law(SceneSection& section);

/// Reads every key of a law, so that all are known, and refuses
/// those that are present: "has no meaning with `source`".
void refuse_law(SceneSection& section, const std::string& source);

} // namespace isostat
