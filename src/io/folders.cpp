#include "io/folders.hpp"

#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/record_digests.hpp"

#include <isostat/io/run_directory.hpp>

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <ranges>

namespace isostat {

namespace fs = std::filesystem;

namespace {

/// What is left of a pattern behind a name that it begins with; nothing: it does not.
std::optional<std::string_view> behind(std::string_view pattern, std::string_view name) {
    constexpr std::string_view digits = "0123456789";
    while (!name.empty()) {
        if (pattern.starts_with('#')) {
            const std::size_t least = std::min(pattern.find_first_not_of('#'), pattern.size());
            const std::size_t found = std::min(name.find_first_not_of(digits), name.size());
            if (found < least || (found > least && name.starts_with('0'))) {
                return {};
            }
            pattern.remove_prefix(least);
            name.remove_prefix(found);
        } else if (!pattern.empty() && pattern.front() == name.front()) {
            pattern.remove_prefix(1);
            name.remove_prefix(1);
        } else {
            return {};
        }
    }
    return pattern;
}

std::vector<std::string> names_in(const std::string& folder, const std::vector<std::string>& names) {
    std::vector<std::string> all;
    std::ranges::transform(names, std::back_inserter(all), [&](const std::string& name) { return folder + name; });
    return all;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// A chart: its data, its script, what gnuplot makes of them.
std::vector<std::string> chart_names(const std::string& chart) {
    return names_in(chart, {".dat", ".gp", ".gp.log", ".svg", ".png", ".pdf"});
}

std::vector<std::string> report_names() {
    std::vector<std::string> names{"report.txt", "trajectory.html", "soft_limits.csv", "forces.vtk.series"};
    for (const char* chart : {"staircase", "triaxial", "cycles", "stress_increments", "strain_increments"}) {
        names = joined(names, chart_names(chart));
    }
    for (const char* state : {"forces_eq_######", "forces_last"}) {
        names = joined(names, names_in(state, {".svg", ".vtk"}));
    }
    return joined(names, {"contacts_eq_######.csv", "contacts_last.csv"});
}

std::vector<std::string> run_names() {
    return joined({"lock", "run.json", "events.jsonl", "equilibria.csv", "checkpoint.json", "summary.json",
                   "start.json", "work.json", "preparation_failed.json", "states/eq_######.json", last_state,
                   "certificates/eq_######.json", witness_records},
                  names_in("figures/", report_names()));
}

/// What an ensemble puts where the run of a sample goes; a run neither writes nor removes it.
const std::array<std::string, 3> sample_names{"scene.toml", "log.txt", "sample.json"};

std::vector<std::string> ensemble_names() {
    const std::vector<std::string> sample = joined(run_names(), {sample_names.begin(), sample_names.end()});
    return joined(joined({"lock", "ensemble.json", "equilibria.csv", "increments.csv", "samples.csv"},
                         chart_names("figures/force_distribution")),
                  names_in("samples/seed_######/", sample));
}

std::vector<std::string> comparison_names() {
    return joined(joined(chart_names("comparison"), {"comparison.csv", "comparison.json", "path.csv"}),
                  names_in("bundle/", {"nodes.csv", "members.csv", "node_####.json"}));
}

void look(const fs::path& folder, const std::string& before, const FolderKind& kind, FolderContent& found) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = before + entry.path().filename().string();
        const fs::file_type type = entry.symlink_status().type();
        if (type == fs::file_type::not_found || std::ranges::count(sample_names, name) > 0) {
            continue; // a temporary file that was renamed meanwhile; or what is there before the run of a sample begins
        }
        const bool file = kind.owns(name);
        const std::string whole = name_of_temporary(name);
        if (file || kind.owns_folder(name)) {
            if (type != (file ? fs::file_type::regular : fs::file_type::directory)) {
                refuse(entry.path().string(), "expected a {} that is no link", file ? "regular file" : "folder");
            }
            (file ? found.files : found.folders).push_back(name);
        } else if (type == fs::file_type::regular && !whole.empty() && kind.owns(whole)) {
            found.leftovers.push_back(name);
        } else {
            found.others.push_back(name);
        }
        if (!file && kind.owns_folder(name)) {
            look(entry.path(), name + "/", kind, found);
        }
    }
}

bool has(const std::vector<std::string>& names, const char* name) {
    return std::ranges::find(names, name) != names.end();
}

/// Nothing is there, or what a kill leaves before the mark is written.
bool is_unused(const FolderContent& content) {
    const bool locked = has(content.files, "lock");
    return content.others.empty() && content.files.size() == (locked ? 1 : 0) && (locked || content.leftovers.empty());
}

[[noreturn]] void refuse_to_resume(const fs::path& folder, const FolderKind& kind) {
    const std::string_view words = kind.words;
    refuse((folder / kind.mark).string(), "does not exist: there is no {} to resume",
           words.substr(words.find(' ') + 1));
}

[[noreturn]] void refuse_to_write(const fs::path& folder, const FolderKind& kind, const FolderContent& content) {
    const bool other_run = &kind != &run_folder && fs::exists(folder / run_folder.mark);
    const auto& names = !content.others.empty()  ? content.others
                        : !content.files.empty() ? content.files
                                                 : content.leftovers;
    const std::string holds = other_run ? run_folder.words : names.front();
    refuse(ErrorKind::usage, "{}: holds {}{}, and is not the folder of {}: expected an empty folder", folder.string(),
           holds, other_run ? " already" : "", kind.words);
}

/// What is there, when it may be taken.
FolderContent checked(const fs::path& folder, const FolderKind& kind, FolderMode mode) {
    if (!fs::is_directory(folder)) {
        if (mode == FolderMode::resume) {
            refuse_to_resume(folder, kind);
        }
        return {}; // whoever makes it says what is wrong
    }
    const bool resumes = mode == FolderMode::resume;
    try {
        FolderContent content = content_of(folder, kind);
        if (!has(content.files, kind.mark)) {
            if (resumes && !(has(content.files, "lock") && is_unused(content))) {
                refuse_to_resume(folder, kind);
            }
            if (!resumes && !is_unused(content)) {
                refuse_to_write(folder, kind, content);
            }
            return content;
        }
        check_mark(folder, kind);
        if (mode == FolderMode::fresh) {
            refuse(ErrorKind::usage,
                   "{}: holds {} already: expected an empty folder, --resume to go on or --force to delete it first",
                   folder.string(), kind.words);
        }
        return content;
    } catch (const Error& error) {
        if (resumes || error.kind() == ErrorKind::usage) {
            throw;
        }
        refuse(ErrorKind::usage, "{} (what is there is not known to be {}: expected an empty folder)", error.what(),
               kind.words);
    }
}

Descriptor locked(const fs::path& folder, int flags) {
    Descriptor lock = Descriptor::open(folder / "lock", O_RDWR | O_NOFOLLOW | flags);
    if (!lock.try_lock()) {
        refuse(ErrorKind::cannot_write, "{}: another running program writes into this folder", folder.string());
    }
    return lock;
}

} // namespace

const FolderKind run_folder{"a run", "run.json", "isostat-run", run_names()};
const FolderKind ensemble_folder{"an ensemble", "ensemble.json", "isostat-ensemble", ensemble_names()};
const FolderKind report_folder{"a report", "report.txt", "status  ", report_names()};
const FolderKind comparison_folder{"a comparison", "comparison.json", "isostat-comparison", comparison_names()};

std::string state_name(int equilibrium) {
    return fmt::format("states/eq_{:06}.json", equilibrium);
}

std::string certificate_name(int equilibrium) {
    return fmt::format("certificates/eq_{:06}.json", equilibrium);
}

bool FolderKind::owns(std::string_view name) const {
    return std::ranges::any_of(names, [&](const std::string& pattern) {
        const auto rest = behind(pattern, name);
        return rest && rest->empty();
    });
}

bool FolderKind::owns_folder(std::string_view name) const {
    return std::ranges::any_of(names, [&](const std::string& pattern) {
        const auto rest = behind(pattern, name);
        return rest && rest->starts_with('/');
    });
}

FolderContent content_of(const fs::path& folder, const FolderKind& kind) {
    FolderContent found;
    if (fs::is_directory(folder)) {
        look(folder, "", kind, found);
    }
    for (auto* names : {&found.files, &found.folders, &found.leftovers, &found.others}) {
        std::ranges::sort(*names);
    }
    return found;
}

void check_mark(const fs::path& folder, const FolderKind& kind) {
    const fs::path mark = folder / kind.mark;
    if (mark.extension() != ".json") {
        if (!is_marked(mark, kind.format)) {
            refuse(mark.string(), "is not of {}", kind.words);
        }
        return;
    }
    const json::Json parsed = json::Field::parse(read_text(mark), mark.string());
    const json::Field file(parsed, mark.string());
    if (file.at("format").string() != kind.format) {
        file.at("format").fail("\"{}\"", kind.format);
    }
    (void)file.at("version").integer(1, 1);
}

std::vector<std::string> notes_on(const FolderContent& content, const FolderKind& kind) {
    std::vector<std::string> notes;
    for (const std::string& name : content.others) {
        notes.push_back(fmt::format("{} is no file of {}: it was left alone", name, kind.words));
    }
    return notes;
}

TakenFolder take_folder(const fs::path& folder, const FolderKind& kind, FolderMode mode) {
    TakenFolder taken;
    if (fs::is_regular_file(fs::symlink_status(folder / "lock"))) {
        taken.lock = locked(folder, 0);
    } else {
        (void)checked(folder, kind, mode); // a folder that is refused gets no lock
        make_directory(folder);
        taken.lock = locked(folder, O_CREAT);
    }
    taken.before = checked(folder, kind, mode);
    taken.begun = has(taken.before.files, kind.mark);
    if (mode != FolderMode::resume) {
        std::erase(taken.before.files, "lock");
        remove_files(folder, taken.begun ? taken.before.files : std::vector<std::string>(), {});
        remove_files(folder, taken.before.leftovers, taken.before.folders);
    }
    return taken;
}

void check_folder_for(const fs::path& folder, const FolderKind& kind) {
    (void)checked(folder, kind, FolderMode::force);
}

void make_folder_for(const fs::path& folder, const FolderKind& kind) {
    const FolderContent content = checked(folder, kind, FolderMode::force);
    make_directory(folder);
    remove_files(folder, content.leftovers);
}

void remove_files(const fs::path& folder, const std::vector<std::string>& files,
                  const std::vector<std::string>& folders) {
    for (const std::string& name : files) {
        fs::remove(folder / name);
    }
    for (const std::string& name : std::ranges::reverse_view(folders)) {
        std::error_code holds_others;
        fs::remove(folder / name, holds_others);
    }
}

} // namespace isostat
