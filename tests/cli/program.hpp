#pragma once
// The real program, run as a user runs it.

#include "support/scratch.hpp"

#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace program {

using Arguments = std::vector<std::string>;

struct Outcome {
    int status = -1; ///< exit status; 128 + signal when it was killed
    std::string out, err;
};

inline std::string quoted(const std::string& word) {
    std::string safe = "'";
    for (const char c : word) {
        safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return safe + "'";
}

/// Runs `isostat ARGUMENTS` to its end; `before` goes in front of the command ("PATH= ", "cd x; ").
inline Outcome run(const Arguments& arguments, const std::string& before = "") {
    const scratch::Folder folder;
    std::string line = before + quoted(ISOSTAT_PROGRAM);
    for (const std::string& argument : arguments) {
        line += " " + quoted(argument);
    }
    line += " >" + quoted(folder.at("out")) + " 2>" + quoted(folder.at("err")) + " </dev/null";
    const int status = std::system(line.c_str());
    Outcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = scratch::read(folder / "out");
    outcome.err = scratch::read(folder / "err");
    return outcome;
}

inline bool contains(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

/// Exit status, and all of the words on standard error.
inline void expect(const Outcome& outcome, int status, const Arguments& words = {}) {
    BOOST_TEST(outcome.status == status,
               "exit status " << outcome.status << ", expected " << status << "; " << outcome.err);
    for (const std::string& word : words) {
        BOOST_TEST(contains(outcome.err, word), "'" << word << "' is not in: " << outcome.err);
    }
}

/// What has this exit status.
inline Outcome done(Outcome outcome, int status = 0) {
    expect(outcome, status);
    return outcome;
}

/// Exit status, and all of the words on standard output.
inline Outcome says(Outcome outcome, int status, const Arguments& words) {
    expect(outcome, status);
    for (const std::string& word : words) {
        BOOST_TEST(contains(outcome.out, word), "'" << word << "' is not in: " << outcome.out << outcome.err);
    }
    return outcome;
}

/// The words of a command, and some more.
inline Arguments plus(Arguments words, const Arguments& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// A scene, written into a folder and run there with this exit status, or with any: the folder of the run.
inline std::string ran(const scratch::Folder& folder, const std::string& scene, std::optional<int> status = 0,
                       const Arguments& said = {}) {
    scratch::write_scene(folder / "s.toml", scene);
    const Outcome outcome = run({"run", folder.at("s.toml"), "-o", folder.at("run"), "-q"});
    if (status) {
        expect(outcome, *status, said);
    }
    return folder.at("run");
}

/// The JSON on standard output.
inline nlohmann::json json_of(const Outcome& outcome, int status = 0) {
    expect(outcome, status);
    return nlohmann::json::parse(outcome.out);
}

/// What an answer has under names, or under paths like "counts/h".
inline void has(const nlohmann::json& found, const nlohmann::json& expected) {
    for (const auto& [path, value] : expected.items()) {
        const auto& there = found.at(nlohmann::json::json_pointer("/" + path));
        BOOST_TEST(there == value, path << " is " << there << ", not " << value);
    }
}

/// Two runs have the same records, states and certificates, but for times and for the names of their folders.
inline void same_records(const std::filesystem::path& a, const std::filesystem::path& b) {
    namespace fs = std::filesystem;
    BOOST_TEST((scratch::read(a / "events.jsonl") == scratch::read(b / "events.jsonl")));
    BOOST_TEST(scratch::without_times(scratch::read(a / "equilibria.csv")) ==
               scratch::without_times(scratch::read(b / "equilibria.csv")));
    int states = 0;
    for (const char* folder : {"states", "certificates"}) {
        if (!fs::exists(a / folder)) {
            continue;
        }
        for (const auto& entry : fs::directory_iterator(a / folder)) {
            const fs::path other = b / folder / entry.path().filename();
            const auto body = [](const fs::path& file) { // what comes before the load names the folder
                const std::string text = scratch::read(file);
                const std::size_t begin = std::min(text.find("\"load\""), text.size());
                return file.extension() == ".jsonl" ? text : text.substr(begin, text.rfind("\"digest\"") - begin);
            };
            BOOST_TEST(!body(entry.path()).empty(), other.string());
            BOOST_TEST((body(entry.path()) == body(other)), other.string());
            ++states;
        }
    }
    BOOST_TEST(states >= 4);
}

/// A scene that starts from a sample and does what `programme` says.
inline std::string scene_from(const std::string& file, const std::string& programme, const std::string& rest = "") {
    return "[packing]\nfile = \"" + file + "\"\n" + programme + "[output]\npictures = false\n" + rest;
}

inline std::string up(int equilibria) {
    return "[[programme]]\ndo = \"up\"\nequilibria = " + std::to_string(equilibria) + "\n";
}

} // namespace program
