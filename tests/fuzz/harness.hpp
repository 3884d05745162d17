#pragma once
// Mutants of a file are given to its reader: it must end with success and something sound, or with Error(bad_input) and
// the name of the file; nothing else, and soon.

#include "fuzz/mutation.hpp"

#include <isostat/contact/state.hpp>

#include <ctime>

namespace fuzz {

using namespace isostat;

/// ISOSTAT_LONG=1: twenty times as many files, a million in all; 3: three times.
inline int effort() {
    const char* const asked = std::getenv("ISOSTAT_LONG"); // NOLINT(concurrency-mt-unsafe): one thread
    const int times = asked != nullptr ? std::atoi(asked) : 0;
    return times == 1 ? 20 : std::max(1, times);
}

struct Count {
    long accepted = 0, refused = 0;
    double seconds = 0, slowest = 0;
};
/// Of all cases of this process.
inline Count& all_files() {
    static Count tally;
    return tally;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr double longest = 20; // seconds for one file
#else
constexpr double longest = 2;
#endif

/// `read` throws, or says what is unsound about what it read: nothing when all is well.
inline Count fuzz(const std::string& name, const std::string& text, int samples,
                  const std::function<std::string(const std::string&)>& read) {
    Random random(2024);
    Count tally;
    BOOST_TEST_REQUIRE(read(text) == "", name << ": the original is read");
    for (int s = 0; s < samples * effort(); ++s) {
        const std::string changed = mutated(text, random);
        BOOST_TEST_CHECKPOINT(name << ", sample " << s); // named when the process crashes
        const std::clock_t begin = std::clock();         // processor time: other work on the machine does not change it
        try {
            const std::string wrong = read(changed);
            if (!wrong.empty()) {
                BOOST_ERROR(name + ", sample " + std::to_string(s) + ": accepted, but " + wrong + ":\n" +
                            changed.substr(0, 2000));
            }
            ++tally.accepted;
        } catch (const Error& error) {
            const std::string message = error.what();
            if (!message.starts_with("FILE") || message.size() < 12 || error.kind() != ErrorKind::bad_input) {
                BOOST_ERROR(name + ", sample " + std::to_string(s) + ": " + message);
            }
            ++tally.refused;
        } catch (const std::exception& error) {
            BOOST_ERROR(name + ", sample " + std::to_string(s) + ": " + error.what() + "\n" + changed.substr(0, 2000));
        }
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        tally.seconds += seconds;
        tally.slowest = std::max(tally.slowest, seconds);
    }
    BOOST_TEST(tally.slowest < longest, name << ": " << tally.slowest << " s for one file");
    BOOST_TEST_MESSAGE(name << ": " << tally.refused << " refused, " << tally.accepted << " accepted, " << tally.seconds
                            << " s, slowest " << tally.slowest << " s");
    Count& all = all_files();
    all.accepted += tally.accepted;
    all.refused += tally.refused;
    all.seconds += tally.seconds;
    all.slowest = std::max(all.slowest, tally.slowest);
    return tally;
}

inline std::string unsound(const Packing& packing) {
    const auto finite = [](double x) { return std::isfinite(x); };
    const auto positive = [](double r) { return r > 0 && std::isfinite(r); };
    if (packing.radius.empty() || packing.q.size() != packing.coordinate_count() ||
        !(packing.fixed.empty() || packing.fixed.size() == packing.radius.size())) {
        return "sizes do not fit";
    }
    if (!std::ranges::all_of(packing.radius, positive)) {
        return "a radius is not positive and finite";
    }
    return std::ranges::all_of(packing.q, finite) ? "" : "a coordinate is not finite";
}

inline std::string unsound(const State& state) {
    if (std::string wrong = unsound(state.packing); !wrong.empty()) {
        return wrong;
    }
    const int n = state.packing.disk_count();
    std::vector<Contact> sorted = state.contacts;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) {
        return "a contact comes twice";
    }
    for (const Contact& c : state.contacts) {
        const bool pair = c.kind == ContactKind::disk_disk;
        const bool ordered = c.i < c.j || (c.i == c.j && c.image != Image());
        if (c.i < 0 || c.j < 0 || c.i >= (c.kind == ContactKind::held ? static_cast<int>(state.packing.q.size()) : n) ||
            !(pair ? ordered && c.j < n : c.j < state.packing.dimension)) {
            return "a contact is out of range";
        }
    }
    const std::size_t loads = state.load.infinitesimal.size();
    return loads == 0 || loads == state.packing.length_at(0) ? "" : "infinitesimal loads do not fit";
}

/// Lines, with or without the last end of line; a byte order mark is none of them, nor is the \r of Windows.
inline std::vector<std::string> lines_of(std::string text) {
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.erase(0, 3);
    }
    return scratch::split(text, '\n');
}

/// Neither blank nor a comment.
inline bool has_content(const std::string& line, const std::string& blanks = " \t\r") {
    const std::size_t first = line.find_first_not_of(blanks);
    return first != std::string::npos && line[first] != '#' && line[first] != '%';
}

inline std::string rows_differ(std::size_t read, std::size_t counted) {
    return read == counted ? "" : std::to_string(read) + " rows were read of " + std::to_string(counted);
}

} // namespace fuzz
