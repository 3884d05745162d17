#include "compare/manifest.hpp"

#include "io/files.hpp"
#include "io/lines.hpp"
#include "io/section.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat::compare {

namespace {

constexpr const char* format_name = "isostat-series 1";

std::string required(Section& section, const std::string& key, const std::string& expected) {
    (void)section.required(key, expected);
    auto text = section.string(key);
    if (text->empty()) {
        section.fail(key, expected);
    }
    return *text;
}

double positive(Section& section, const std::string& key, std::optional<double> fallback) {
    if (!fallback) {
        (void)section.required(key, "a positive number");
    }
    const auto value = section.number(key);
    if (value && !(*value > 0)) {
        section.fail(key, "a positive number");
    }
    return value ? *value : *fallback;
}

void read_files(Section& section, const std::filesystem::path& folder, Manifest& out) {
    (void)required(section, "disks", "the name of a LAMMPS dump");
    (void)required(section, "frames", "the name of a table (CSV)");
    out.disks = section.file("disks", folder)->string();
    out.frames = section.file("frames", folder)->string();
    out.contacts = section.file("contacts", folder).value_or("").string();
    if (const auto select = section.string("select")) {
        const std::size_t blank = select->find(' ');
        if (blank == std::string::npos || select->find(' ', blank + 1) != std::string::npos) {
            section.fail("select", "a column and its value, for instance \"type 1\"");
        }
        out.select_column = select->substr(0, blank);
        out.select_value = select->substr(blank + 1);
    }
    section.finish();
}

void read_columns(Section& section, const std::string& source, Manifest& out) {
    out.series.listed = !out.contacts.empty();
    if (out.series.listed) {
        out.contact_i = required(section, "contact_i", "the column of the first id in the file of contacts");
        out.contact_j = required(section, "contact_j", "the column of the second id in the file of contacts");
        std::string force = required(section, "contact_force", "the column of the force, positive in compression");
        for (std::size_t comma = force.find(','); comma != std::string::npos; comma = force.find(',')) {
            out.contact_force.push_back(force.substr(0, comma));
            force.erase(0, comma + 1);
        }
        out.contact_force.push_back(force);
        if (const std::size_t count = out.contact_force.size();
            count != 1 && (count < out.axes() || count > most_axes)) {
            section.fail("contact_force", "one column, or those of a vector, \"fx,fy\"");
        }
    }
    const auto radius = section.string("radius"), diameter = section.string("diameter");
    if (radius && diameter) {
        section.refuse("diameter", "radius and diameter: expected one of them");
    }
    out.size = radius.value_or(diameter.value_or("radius"));
    out.diameters = diameter.has_value();
    if (const toml::table* walls = section.table("wall_force")) {
        Section columns(walls, "columns.wall_force", source);
        for (const std::string& name : out.wall_names()) {
            out.wall_force.push_back(required(columns, name, "the column of the force of this wall on a grain"));
        }
        columns.finish();
        out.series.wall_forces = true;
    }
    section.finish();
}

void read_law(Section& section, Manifest& out) {
    out.series.law = section.word("kind", ForceLaw::none, force_law_words);
    if (out.series.law != ForceLaw::none) {
        out.series.stiffness = positive(section, "stiffness", std::nullopt);
    }
    out.series.agreement = positive(section, "allowance", out.series.agreement);
    section.finish();
}

void read_load(Section& section, Manifest& out) {
    out.load = section.word("kind", LoadKind::nominal, load_kind_words);
    (void)section.required("reference_length", "[L1, L2], of spheres [L1, L2, L3]");
    const auto lengths = section.numbers("reference_length");
    const bool positive_all = std::ranges::all_of(*lengths, [](double length) { return length > 0; });
    if ((lengths->size() != 2 && lengths->size() != 3) || !positive_all) {
        section.fail("reference_length", "two positive numbers, of spheres three");
    }
    std::ranges::copy(*lengths, out.reference_length.begin());
    out.series.dimension = static_cast<int>(lengths->size());
    out.series.several = !section.number("sigma1");
    for (std::size_t a = 0; a + 1 < out.axes(); ++a) {
        const std::string key = fmt::format("sigma{}", a + 1);
        if (!out.series.several) {
            out.stress[a] = positive(section, key, std::nullopt);
        } else if (section.number(key)) {
            section.fail(key, "sigma1 beside it, or none of them: then each frame has its own");
        }
    }
    section.finish();
}

} // namespace

std::vector<std::string> Manifest::wall_names() const {
    std::vector<std::string> out;
    for (std::size_t w = 0; w < 2 * axes(); ++w) {
        out.push_back(wall_name(with_wall(0, w)));
    }
    return out;
}

Contact Manifest::with_wall(int grain, std::size_t wall) const {
    return {wall_facts[wall / axes()].kind, grain, static_cast<int>(wall % axes())};
}

double Manifest::reference_area(std::size_t axis) const {
    double out = 1;
    for (std::size_t b = 0; b < axes(); ++b) {
        out *= b == axis ? 1 : reference_length[b];
    }
    return out;
}

Manifest read_manifest(const std::filesystem::path& path) {
    const std::string source = path.string();
    const std::string text = read_text(path);
    const toml::table document = parse_toml(without_byte_order_mark(text), source);
    Manifest out;
    Section top(&document, "manifest", source);
    if (required(top, "format", fmt::format("\"{}\"", format_name)) != format_name) {
        top.fail("format", "\"{}\"", format_name);
    }
    out.series.title = top.string("title").value_or("");
    out.series.program = top.string("program").value_or("");
    out.periodic = top.table("cell") != nullptr;
    const auto section = [&](const char* name) { return Section(top.table(name), name, source); };
    Section files = section("files");
    read_files(files, path.parent_path(), out);
    Section load = section("load");
    read_load(load, out); // decides whether the grains are disks or spheres
    Section columns = section("columns");
    read_columns(columns, source, out);
    Section cell = section("cell");
    enum class Kind : unsigned char { rectangular, tilted };
    out.tilted = cell.word("kind", Kind::rectangular, words_of<Kind>("rectangular", "tilted")) == Kind::tilted;
    cell.finish();
    if (out.periodic && out.series.wall_forces) {
        columns.refuse("wall_force", "wall_force and a [cell]: expected no walls");
    }
    Section law = section("law");
    read_law(law, out);
    if (out.tilted && out.load == LoadKind::true_stress) {
        load.refuse("kind", "true stresses and a tilt that moves: expected \"nominal\", or kind = \"rectangular\" in "
                            "[cell] (they have no potential)");
    }
    Section rest = section("rest");
    out.series.rest = positive(rest, "allowance", out.series.rest);
    rest.finish();
    Section units = section("units");
    out.length_factor = positive(units, "length", 1.0);
    out.force_factor = positive(units, "force", 1.0);
    units.finish();
    top.finish();
    return out;
}

} // namespace isostat::compare
