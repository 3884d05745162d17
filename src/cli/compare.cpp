#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/ranges.hpp"
#include "cli/read_packing.hpp"
#include "cli/terminal.hpp"
#include "compare/manifest.hpp"
#include "compare/report.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

namespace isostat::cli {

namespace {

/// Equilibrium 0 of a run, or a state file.
State start_of(const std::string& reference) {
    const std::filesystem::path path = reference;
    if (std::filesystem::is_directory(path)) {
        (void)content_of(path, run_folder);
    }
    return read_any_state(std::filesystem::is_directory(path) ? path / state_name(0) : path, Dimensions::any).state;
}

/// Writes a manifest for a file of frames in its folder or below.
void begin_manifest(const CompareArguments& a) {
    const std::filesystem::path manifest = a.series, folder = manifest.parent_path();
    const std::filesystem::path disks = std::filesystem::path(a.init).lexically_proximate(folder);
    if (disks.is_absolute() || (!disks.empty() && *disks.begin() == "..")) {
        refuse(ErrorKind::usage, "--init is '{}': expected a file beside {} or below", a.init, a.series);
    }
    const std::string frames = manifest.stem().string() + ".frames.csv";
    for (const std::filesystem::path& file : {manifest, folder / frames}) {
        if (std::filesystem::exists(std::filesystem::symlink_status(file))) {
            refuse(ErrorKind::usage, "{} exists: expected a new name", file.string());
        }
    }
    const compare::BegunSeries begun = compare::begin_series(a.init, disks.string(), frames);
    write_atomically(folder / frames, begun.frames);
    write_atomically(manifest, begun.manifest);
    say("{} and {} are written: fill in the loads{}, then isostat compare {}\n", a.series, (folder / frames).string(),
        begun.frames.find(",left") == std::string::npos ? "" : " and the positions of the walls", a.series);
}

std::string shown(double x) {
    return std::isfinite(x) ? fmt::format("{:.1e}", x) : "-";
}

std::string loaded_name(const compare::Comparison& comparison) {
    return fmt::format("sigma{}", comparison.dimension);
}

void print_frames(const compare::Comparison& comparison) {
    say("{:>5} {:>9} {:>10} {:>5} {:>5} {:>3} {:>3} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6}  {}\n", "frame",
        loaded_name(comparison), "unbalanced", "N", "N_f", "h", "k", "rattlers", "distance", "law", "rest", "stiff",
        "exact", "status");
    for (const compare::FrameResult& f : comparison.frames) {
        const std::string place = f.expected < 0          ? "-"
                                  : f.found == f.expected ? fmt::format("{}", f.expected)
                                  : f.found < 0           ? fmt::format("{}/-", f.expected)
                                                          : fmt::format("{}/{}", f.expected, f.found);
        const std::string local = f.local.empty() ? "" : fmt::format("; from the frame before: {}", f.local);
        const std::string arc = f.nearest_arc.empty() ? "" : "; " + f.nearest_arc;
        say("{:>5} {:>9.6g} {:>10} {:>5} {:>5} {:>3} {:>3} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6}  {}{}{}{}{}\n", f.frame,
            f.stress, shown(f.unbalanced), f.counting.contact_count, f.counting.dof_count, f.counting.hyperstaticity,
            f.counting.mechanisms, f.rattlers, shown(f.distance), shown(f.law), shown(f.rest), shown(f.stiffness),
            place, to_string(f.status), f.reason.empty() ? "" : ": ", f.reason, local, arc);
    }
}

/// Prints how many frames are where the exact run from the previous frame ends.
void print_local(const std::vector<compare::FrameResult>& frames) {
    int asked = 0, same = 0;
    for (const compare::FrameResult& f : frames) {
        asked += f.local.empty() ? 0 : 1;
        same += f.local == "same" ? 1 : 0;
    }
    if (asked > 0) {
        say("local: {} of {} frames are where the exact run from the frame before ends\n", same, asked);
    }
}

void print_bundle(const compare::Bundle& bundle) {
    if (bundle.members.size() < 2) {
        return;
    }
    say("\nbundle: {} exact runs from the same start come through {} equilibria; the first {} are common to all\n",
        bundle.members.size(), bundle.nodes.size(), bundle.common);
}

/// Prints the loads on both sides of the departure, and the limits of the exact run between them.
void print_loads(const compare::Comparison& comparison, const compare::Departure& departure) {
    const auto load = [&](int number) {
        const auto at =
            std::ranges::find_if(comparison.frames, [&](const compare::FrameResult& f) { return f.frame == number; });
        return at == comparison.frames.end() ? comparison.frames.front().stress : at->stress;
    };
    const double from = load(departure.from), to = load(departure.to);
    std::string limits;
    for (const compare::PathEquilibrium& e : comparison.path) {
        limits += e.arcs > 0 && std::min(from, to) <= e.stress && e.stress <= std::max(from, to)
                      ? fmt::format(" {:.7g}", e.stress)
                      : "";
    }
    say("  {} {:.7g} -> {:.7g}; limits of the exact run between:{}\n", loaded_name(comparison), from, to,
        limits.empty() ? " none" : limits);
}

void print_ends(const compare::Comparison& comparison, double stiffness) {
    if (stiffness > 0) {
        say("\n{:>5} {:>10} {:>10} {:>12} {:>11}  {}   (predictions)\n", "exact", "from", "to", "soft limit",
            "K for 1e-3", "opens");
        for (const compare::PathEquilibrium& e : comparison.path) {
            say("{:>5} {:>10.6f} {:>10.6f} {:>12.6f} {:>11}  {}\n", e.number, e.low, e.high, e.soft_limit,
                shown(e.stiffness_needed), e.opens.i < 0 ? "-" : to_string(e.opens, comparison.dimension));
        }
    }
    if (!comparison.path_end.empty()) {
        say("\nthe exact run ends: {}\n", comparison.path_end);
    }
    print_bundle(comparison.bundle);
    std::array<int, compare::frame_statuses> counts{};
    for (const compare::FrameResult& f : comparison.frames) {
        ++counts[static_cast<std::size_t>(f.status)];
    }
    std::string text;
    for (std::size_t s = 0; s < counts.size(); ++s) {
        if (counts[s] > 0) {
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[s],
                                to_string(static_cast<compare::FrameStatus>(s)));
        }
    }
    say("\n{} frames: {}\n", comparison.frames.size(), text);
    print_local(comparison.frames);
    if (const auto& d = comparison.departure) {
        say("FIRST DEPARTURE: frames {} -> {}: {}: {}\n", d->from < 0 ? "-" : std::to_string(d->from), d->to, d->reason,
            d->words);
        print_loads(comparison, *d);
        say("  opened{}; closed{}\n", compare::names_of(d->opened, comparison.dimension),
            compare::names_of(d->closed, comparison.dimension));
    }
}

} // namespace

int compare_series(const CompareArguments& a) {
    if (!a.output.empty()) {
        check_folder_for(a.output, comparison_folder);
    }
    compare::CompareOptions options = a.options;
    if (!a.frames.empty()) {
        const std::vector<std::string> ends = parse_list(a.frames, ':');
        const auto frame = [](const std::string& word) {
            return ranges::integer_in(word, 0, std::numeric_limits<int>::max()).value_or(-1);
        };
        if (ends.size() != 2 || frame(ends[0]) < 0 || frame(ends[1]) < frame(ends[0])) {
            refuse(ErrorKind::usage, "--frames is '{}': expected A:B, two integers with 0 <= A <= B", a.frames);
        }
        options.frames = {static_cast<int>(frame(ends[0])), static_cast<int>(frame(ends[1]))};
    }
    if (!a.init.empty()) {
        begin_manifest(a);
        return done;
    }
    compare::SeriesReader reader(a.series);
    const compare::Series& series = reader.series();
    if (!a.reference.empty()) {
        options.start = start_of(a.reference);
    }
    catch_interrupts();
    options.stop = &stop_flag();
    const compare::Comparison comparison = compare::compare(reader, options);
    if (stop_flag()) {
        return interrupted;
    }
    if (comparison.frames.empty()) {
        refuse(ErrorKind::usage, "--frames is '{}': {} has no such frame", a.frames, a.series);
    }
    std::string note;
    if (!a.output.empty()) {
        note = compare::write_comparison(a.output, series, comparison);
    }
    if (a.common.json) {
        say_json(compare::comparison_json(series, comparison));
    } else {
        if (!a.common.quiet) {
            print_frames(comparison);
        }
        if (series.several) {
            say("\n{} is over sigma1, which varies: the exact run has sigma1 = 1, soft limits are not predicted\n",
                loaded_name(comparison));
        }
        print_ends(comparison, a.common.quiet ? 0 : series.linear_stiffness());
        if (series.law == compare::ForceLaw::none) {
            say("stiffness not tested: the manifest states no [law], forces are taken as they are\n");
        }
    }
    if (!note.empty()) {
        say(stderr, "isostat: {}\n", note);
    }
    return comparison.status;
}

} // namespace isostat::cli
