#include "compare/manifest.hpp"
#include "io/section.hpp"
#include "io/text.hpp"
#include "snap/frame_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat::compare {

namespace {

using foreign::Boundary;

bool is_there(const FileFrame& frame, const char* name) {
    return foreign::find_column(frame.header.names, name) >= 0;
}

std::string manifest_of(const FileFrame& first, std::size_t axes, bool periodic, const std::string& name,
                        const std::string& frames) {
    const bool diameters = is_there(first, "diameter") && !is_there(first, "radius");
    const bool tilted = first.header.tilt != PerTilt<double>{};
    std::vector<double> lengths(axes, 1);
    for (std::size_t a = 0; a < axes && first.header.box; ++a) {
        lengths[a] = (*first.header.box)[a][1] - (*first.header.box)[a][0];
    }
    const std::string stresses = axes == 2 ? "sigma1 = 1.0" : "sigma1 = 1.0\nsigma2 = 1.0";
    return fmt::format("format = \"isostat-series 1\"\n\n"
                       "[files]\ndisks = {} # its columns: {}\nframes = {} # to fill in\n"
                       "# contacts = \"pairs.dump\" # two ids and a force; without it contacts are overlaps\n"
                       "# select = \"type 1\"\n\n"
                       "[columns]\n{}\n# contact_i = \"c_1[1]\"\n# contact_j = \"c_1[2]\"\n# contact_force = "
                       "\"c_2[1]\" # or \"fx,fy\"\n\n{}"
                       "[law]\nkind = \"none\" # or \"linear\", \"hertz\", with stiffness = 1e5\n\n"
                       "[load]\nkind = \"nominal\" # or \"true\"\n{} # to check; where it varies, delete this and fill "
                       "in columns sigma1, ..\nreference_length = [{}] # to check{}\n",
                       toml_text(name), text::shown(fmt::format("{}", fmt::join(first.header.names, " "))),
                       toml_text(frames), diameters ? "diameter = \"diameter\"" : "radius = \"radius\"",
                       periodic ? fmt::format("[cell]\nkind = \"{}\"\n\n", tilted ? "tilted" : "rectangular") : "",
                       stresses, fmt::join(lengths, ", "), first.header.box ? ": the bounds in the first frame" : "");
}

} // namespace

BegunSeries begin_series(const std::filesystem::path& disks, const std::string& name, const std::string& frames) {
    FrameFile file(disks.string(), "ATOMS");
    BegunSeries out;
    bool periodic = false;
    for (auto frame = file.next(); frame; frame = file.next()) {
        if (out.manifest.empty()) {
            (void)file.column(*frame, "id");
            const bool flat = !is_there(*frame, "z") || frame->rows.empty() ||
                              std::ranges::all_of(frame->rows, [&](const TextLine& row) {
                                  const std::size_t z = file.column(*frame, "z");
                                  return row.field(z) == frame->rows.front().field(z);
                              });
            const std::size_t axes = flat ? 2 : 3;
            const auto boundaries = frame->header.boundary.begin();
            periodic = frame->header.box && std::all_of(boundaries, boundaries + static_cast<std::ptrdiff_t>(axes),
                                                        [](Boundary b) { return b == Boundary::periodic; });
            out.manifest = manifest_of(*frame, axes, periodic, name, frames);
            out.frames = fmt::format("timestep{},sigma{}\n",
                                     periodic    ? ""
                                     : axes == 2 ? ",left,bottom,right,top"
                                                 : ",left,bottom,back,right,top,front",
                                     axes);
        }
        const auto commas = std::count(out.frames.begin(), std::ranges::find(out.frames, '\n'), ',');
        out.frames += fmt::format("{}{}\n", frame->header.timestep, std::string(static_cast<std::size_t>(commas), ','));
    }
    if (out.manifest.empty()) {
        file.fail("no frame: expected at least one");
    }
    return out;
}

} // namespace isostat::compare
