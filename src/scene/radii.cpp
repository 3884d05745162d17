#include "io/files.hpp"
#include "io/lines.hpp"
#include "io/section.hpp"
#include "scene/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace isostat {

namespace {

using enum RadiiLaw;

constexpr auto law_words = words_of<RadiiLaw>("uniform", "equal", "bidisperse", "lognormal", "normal", "power");

struct LawKey {
    const char* name;
    std::vector<RadiiLaw> laws; ///< the laws with this key
};

const std::array<LawKey, 6> law_keys{{{"diameters", {uniform, lognormal, normal, power}},
                                      {"diameter", {equal, bidisperse, lognormal, normal}},
                                      {"ratio", {bidisperse}},
                                      {"fraction", {bidisperse}},
                                      {"deviation", {lognormal, normal}},
                                      {"exponent", {power}}}};

std::string word(RadiiLaw law) {
    return toml_text(word_of(law, law_words));
}

bool belongs(const LawKey& key, RadiiLaw law) {
    return std::ranges::find(key.laws, law) != key.laws.end();
}

/// Whether a key is given; reading it marks it as known.
bool given(SceneSection& section, std::string_view key) {
    return key == "diameters" ? section.numbers("diameters").has_value() : section.number(std::string(key)).has_value();
}

/// Refuses the keys of other laws.
void check_keys(SceneSection& section, RadiiLaw law) {
    for (const LawKey& key : law_keys) {
        if (given(section, key.name) && !belongs(key, law)) {
            std::vector<std::string> laws;
            std::ranges::transform(key.laws, std::back_inserter(laws), [](RadiiLaw other) { return word(other); });
            section.refuse(key.name, "'{}' in [packing] goes with law = {} and has no meaning with law = {}", key.name,
                           fmt::join(laws, ", "), word(law));
        }
    }
}

/// Reads [smallest, largest]; `law` holds the defaults.
void read_ends(SceneSection& section, DiameterLaw& law) {
    if (const auto ends = section.numbers("diameters")) {
        if (ends->size() != 2 || !((*ends)[0] >= smallest_size) || !((*ends)[1] >= (*ends)[0]) ||
            !((*ends)[1] <= largest_size)) {
            section.fail("diameters", "[smallest, largest] with 0 < smallest <= largest, from {} to {}", smallest_size,
                         largest_size);
        }
        law.smallest = (*ends)[0];
        law.largest = (*ends)[1];
    }
    section.record("diameters", fmt::format("[{}, {}]", toml_text(law.smallest), toml_text(law.largest)));
}

} // namespace

DiameterLaw read_law(SceneSection& section) {
    DiameterLaw law;
    law.kind = section.word("law", law.kind, law_words);
    check_keys(section, law.kind);
    const auto has = [&](const char* name) {
        return belongs(
            *std::ranges::find_if(law_keys, [&](const LawKey& key) { return key.name == std::string_view(name); }),
            law.kind);
    };
    constexpr double largest_ratio = 1e6;
    if (has("diameter")) {
        law.diameter =
            section.number("diameter", law.diameter, smallest_size, largest_size / largest_ratio,
                           fmt::format("a positive length from {} to {}", smallest_size, largest_size / largest_ratio));
        law.smallest = law.diameter / 2;
        law.largest = 2 * law.diameter;
    }
    if (has("diameters")) {
        read_ends(section, law);
    }
    if (has("ratio")) {
        law.ratio = section.number("ratio", law.ratio, 1, largest_ratio, "a ratio from 1 to 1e6");
        law.fraction = section.number("fraction", law.fraction, 0, 1, "a share of the disks from 0 to 1");
    }
    if (has("deviation")) {
        law.deviation = section.number("deviation", law.deviation, 1e-6, 10, "a number from 1e-6 to 10");
    }
    if (has("exponent")) {
        law.exponent = section.number("exponent", law.exponent, -100, 100, "a number from -100 to 100");
    }
    if (const std::string fault = fault_of(law); !fault.empty()) {
        section.refuse("law", "law = {} in [packing]: {}", word(law.kind), fault);
    }
    return law;
}

void refuse_law(SceneSection& section, const std::string& source) {
    std::vector<std::string> found;
    if (section.string("law")) {
        found.emplace_back("law");
    }
    for (const LawKey& key : law_keys) {
        if (given(section, key.name)) {
            found.emplace_back(key.name);
        }
    }
    if (!found.empty()) {
        section.refuse(found.front(), "'{}' in [packing] goes with 'disks' or 'spheres' and has no meaning with '{}'",
                       found.front(), source);
    }
}

std::vector<double> read_radii(const std::filesystem::path& path) {
    const std::string source = path.string();
    const std::string text = read_text(path);
    TextLines rows(text, source);
    std::vector<double> radii;
    do {
        const std::string name = fmt::format("radius of disk {}", radii.size());
        const TextLine row = rows.next_row(name, 1);
        const double radius = row.number(0, name);
        if (!(radius >= smallest_size && radius <= largest_size)) {
            row.fail(row.field(0), name, "a positive number from {} to {}", smallest_size, largest_size);
        }
        radii.push_back(radius);
    } while (rows.find_row(blanks_or_commas));
    return radii;
}

} // namespace isostat
