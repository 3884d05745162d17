#pragma once
// The real program, run as a user runs it.

#include "support/scratch.hpp"

#include <boost/test/unit_test.hpp>
#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace program {

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
inline Outcome run(const std::vector<std::string>& arguments, const std::string& before = "") {
    const scratch::Folder folder;
    std::string line = before + quoted(ISOSTAT_PROGRAM);
    for (const std::string& argument : arguments) {
        line += " " + quoted(argument);
    }
    line += " >" + quoted((folder / "out").string()) + " 2>" + quoted((folder / "err").string()) + " </dev/null";
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
inline void expect(const Outcome& outcome, int status, const std::vector<std::string>& words = {}) {
    BOOST_TEST(outcome.status == status,
               "exit status " << outcome.status << ", expected " << status << "; " << outcome.err);
    for (const std::string& word : words) {
        BOOST_TEST(contains(outcome.err, word), "'" << word << "' is not in: " << outcome.err);
    }
}

/// A scene that starts from a sample and does what `programme` says.
inline std::string scene_from(const std::string& file, const std::string& programme, const std::string& rest = "") {
    return "[packing]\nfile = \"" + file + "\"\n" + programme + "[output]\npictures = false\n" + rest;
}

inline const std::string up_6 = "[[programme]]\ndo = \"up\"\nequilibria = 6\n";

} // namespace program
