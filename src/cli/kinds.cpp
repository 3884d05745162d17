#include "cli/commands.hpp"
#include "io/files.hpp"

#include <isostat/core/result.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <string_view>
#include <vector>

namespace isostat::cli {

namespace {

namespace fs = std::filesystem;

struct Kind {
    const char* words;
    std::vector<std::string_view> commands; ///< the commands that take this kind
};

const Kind scene{"a scene, which says what to compute", {"run", "plan", "prepare", "ensemble"}};
const Kind packing{"a crafted packing", {"inspect", "import", "genericity", "plateau", "snap"}};
const Kind series{"the manifest of a series", {"compare"}};
const Kind state{"a state", {"inspect", "certify", "report", "export", "snap", "plateau", "genericity", "import"}};
const Kind dump{"a LAMMPS dump", {"plateau", "import", "snap"}};
const Kind data{"a LAMMPS data file", {"plateau", "import", "snap"}};
const Kind xyz{"extended XYZ", {"plateau", "import", "snap"}};
const Kind table{"a table of disks", {"plateau", "import", "snap"}};
const Kind certificate{"a certificate", {"verify"}};
const Kind record{"a file of a run; its folder is meant", {"report", "verify", "export"}};
const Kind folder_of_run{"the folder of a run", {"report", "verify", "export"}};
const Kind folder_of_ensemble{"the folder of an ensemble", {"report", "verify"}};

/// Rows x, y, r: the first row after comments names x and y, or holds at least two numbers and nothing else.
bool is_table(const std::string& begin) {
    static const std::regex comments(R"(^([ \t\r]*(#[^\n]*)?\n)*)");
    static const std::regex numbers(R"(^[ \t]*[-+.\d][-+.\deE]*([,;\s][ \t]*[-+.\d][-+.\deE]*)+[ \t\r]*(\n|$))");
    static const std::regex names(R"(^[ \t"\w]*\bx\b[^\n=:{]*\by\b[^\n=:{]*(\n|$))");
    const std::string rows = std::regex_replace(begin, comments, "", std::regex_constants::format_first_only);
    return std::regex_search(rows, numbers) || std::regex_search(rows, names);
}

const Kind* kind_of_text(const std::string& text) {
    constexpr std::size_t enough = 4096; // a format stands at the beginning
    const std::string begin = text.substr(0, enough);
    static const std::regex format(R"re("?format"?\s*[:=]\s*"isostat-([a-z]+))re");
    std::smatch found;
    if (std::regex_search(begin, found, format)) {
        const std::string name = found[1];
        return name == "state"         ? &state
               : name == "certificate" ? &certificate
               : name == "packing"     ? &packing
               : name == "series"      ? &series
                                       : &record;
    }
    static const std::regex section(R"((^|\n)\s*\[(packing|\[programme\])\])");
    if (std::regex_search(begin, section)) {
        return &scene;
    }
    static const std::regex arc(R"(^\{"step":)");
    if (std::regex_search(begin, arc) || begin.starts_with("# number,previous,")) {
        return &record;
    }
    const std::string foreign = recognise_format(text);
    return foreign == "lammps-dump"                                             ? &dump
           : foreign == "lammps-data"                                           ? &data
           : foreign == "xyz" && begin.find("Properties=") != std::string::npos ? &xyz
           : foreign == "table" && is_table(begin)                              ? &table
                                                                                : nullptr;
}

const Kind* kind_of(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) {
        return fs::exists(file / "run.json", ignored)        ? &folder_of_run
               : fs::exists(file / "ensemble.json", ignored) ? &folder_of_ensemble
                                                             : nullptr;
    }
    if (!fs::is_regular_file(file, ignored)) {
        return nullptr;
    }
    try {
        return kind_of_text(read_text(file));
    } catch (const Error&) {
        return nullptr;
    }
}

} // namespace

std::string other_use(const std::string& command, const fs::path& file) {
    const Kind* const kind = kind_of(file);
    if (kind == nullptr || std::ranges::find(kind->commands, command) != kind->commands.end()) {
        return "";
    }
    return fmt::format("{} is {}: for isostat {}, not for {}{}", file.string(), kind->words,
                       fmt::join(kind->commands, ", "), command,
                       kind == &state && command == "run" ? "; a scene with [packing] file = ... runs it" : "");
}

} // namespace isostat::cli
