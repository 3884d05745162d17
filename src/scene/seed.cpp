#include "scene/seed.hpp"

#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/section.hpp"
#include "scene/settings.hpp"

#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <limits>

namespace isostat {

namespace {

void replace(std::string& text, const toml::source_region& where, const std::string& by) {
    const TomlLines lines(text);
    const std::size_t begin = lines.offset(where.begin);
    text.replace(begin, lines.offset(where.end) - begin, by);
}

/// Writes `radii = [...]` in the place of `radii_file = "..."`.
void put_radii(std::string& text, const toml::table& packing, const std::vector<double>& radii) {
    for (const auto& [key, value] : packing) {
        if (key.str() == "radii_file") {
            replace(text, value.source(), fmt::format("[{}]", fmt::join(radii, ", ")));
            replace(text, key.source(), "radii");
        }
    }
}

} // namespace

std::string with_seed(const std::string& marked, std::uint64_t seed, const std::string& source,
                      const std::filesystem::path& folder) {
    const std::string text(without_byte_order_mark(marked));
    const Scene scene = parse_scene(text, source, folder);
    if (!scene.start.empty()) {
        refuse(source,
               "file in [packing] is {}: a packing that is read has no seed and all samples would be the same: "
               "expected disks, radii or radii_file, or spheres",
               scene.start.string());
    }
    if (seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
        refuse(source, "seed {}: expected at most {}", seed, std::numeric_limits<std::int64_t>::max());
    }
    const auto value_of = [](const toml::table& document, const char* key) { return document["packing"][key].node(); };
    std::string result = text;
    const toml::table original = parse_toml(text, source);
    put_radii(result, *original["packing"].as_table(), scene.preparation.radii);
    const toml::table document = parse_toml(result, source);
    if (const toml::node* old = value_of(document, "seed")) {
        replace(result, old->source(), fmt::format("{}", seed));
    } else {
        const std::size_t header = TomlLines(result).offset(document["packing"].node()->source().begin);
        if (result[header] != '[') {
            refuse(source, "[packing] has no seed that could be replaced: expected seed = 1");
        }
        const std::size_t next = std::min(result.find('\n', header), result.size());
        result.insert(next, fmt::format("\nseed = {}", seed));
    }
    const PreparationOptions made = parse_scene(result, source, folder).preparation;
    if (made.seed != seed || made.radii != scene.preparation.radii) {
        refuse(source, "seed or radii_file of [packing] could not be replaced: expected each on a line of its own");
    }
    return result;
}

} // namespace isostat
