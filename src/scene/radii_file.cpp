#include "io/files.hpp"
#include "io/lines.hpp"
#include "scene/radii.hpp"

#include <fmt/format.h>

namespace isostat {

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
            row.fail(row.field(0), name, fmt::format("a positive number from {} to {}", smallest_size, largest_size));
        }
        radii.push_back(radius);
    } while (rows.find_row(blanks_or_commas));
    return radii;
}

} // namespace isostat
