#pragma once
// Copies of the series tests/data/series with damages.

#include "support/scratch.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <memory>

namespace series {

using Lines = std::vector<std::string>;

inline Lines lines_of(const std::string& name) {
    return scratch::lines_of(scratch::data("series/" + name));
}

inline Lines words_of(const std::string& line, char at = ' ') {
    return scratch::split(line, at);
}
using scratch::joined;

/// The run from one load to the next: `reach(state)` at each. A load where the run is already asks for no arc.
template <class Reach> void run_through(isostat::State state, const std::vector<double>& loads, Reach reach) {
    isostat::RunCounters counters;
    isostat::RunObserver nobody;
    for (const double load : loads) {
        isostat::Segment segment;
        if (load == state.load.loaded_stress()) {
            segment.equilibria = 0;
        } else {
            segment.to_stress = load;
        }
        const isostat::SegmentOutcome outcome = run_segment(state, segment, 0, {}, counters, nobody);
        BOOST_REQUIRE_MESSAGE(!outcome.failure, (outcome.failure ? outcome.failure->message() : ""));
        reach(state);
    }
}

/// The frame contradicts itself, and the reason says how.
inline void is_file(const isostat::compare::FrameResult& frame, const std::string& words) {
    BOOST_TEST((frame.status == isostat::compare::FrameStatus::file), isostat::compare::to_string(frame.status));
    BOOST_TEST((frame.reason.find(words) != std::string::npos), frame.reason);
}

/// All frames are those of the exact run, which rearranged.
inline void are_same(const isostat::compare::Comparison& result, std::size_t frames) {
    BOOST_TEST(result.status == 0);
    BOOST_TEST(result.path_end.empty(), result.path_end);
    BOOST_TEST_REQUIRE(result.frames.size() == frames);
    BOOST_TEST(result.frames.back().expected > 0);
    for (const auto& frame : result.frames) {
        BOOST_TEST((frame.status == isostat::compare::FrameStatus::same), isostat::compare::to_string(frame.status)
                                                                              << ": " << frame.reason);
    }
}

/// The first `frames` frames, to be damaged, in a folder of their own.
class Copy {
  public:
    explicit Copy(std::size_t frames) {
        table.resize(frames + 1);
        cut(disks, frames);
        cut(contacts, frames);
    }
    Lines disks = lines_of("disks.dump"), contacts = lines_of("contacts.dump"), table = lines_of("frames.csv");
    std::string manifest = scratch::read(scratch::data("series/series.toml"));

    [[nodiscard]] std::string write() const {
        const auto put = [&](const char* name, const Lines& lines) {
            scratch::write(*folder_ / name, joined(lines, '\n') + "\n");
        };
        put("disks.dump", disks);
        put("contacts.dump", contacts);
        put("frames.csv", table);
        scratch::write(*folder_ / "series.toml", manifest);
        return (*folder_ / "series.toml").string();
    }
    [[nodiscard]] isostat::compare::Comparison compare(const isostat::compare::CompareOptions& options = {}) const {
        isostat::compare::SeriesReader reader(write());
        return isostat::compare::compare(reader, options);
    }
    /// Number (from 0) of the line of a frame (from 0) and row (from 0) in a dump.
    static std::size_t line(const Lines& dump, std::size_t frame, std::size_t row) {
        std::size_t at = 0;
        for (std::size_t k = 0;; ++k) {
            while (!dump[at].starts_with("ITEM: ATOMS") && !dump[at].starts_with("ITEM: ENTRIES")) {
                ++at;
            }
            ++at;
            if (k == frame) {
                return at + row;
            }
        }
    }
    std::string& disk(std::size_t frame, std::size_t row) { return disks[line(disks, frame, row)]; }
    std::string& contact(std::size_t frame, std::size_t row) { return contacts[line(contacts, frame, row)]; }
    void restate(const std::string& from, const std::string& to) { manifest = scratch::replaced(manifest, from, to); }
    static std::string field(const std::string& line, std::size_t k, const std::string& value) {
        Lines words = words_of(line);
        words[k] = value;
        return joined(words, ' ');
    }
    /// The number in a field becomes `factor` times what it was, and `more`.
    static void change(std::string& line, std::size_t k, double factor, double more = 0) {
        line = field(line, k, fmt::format("{}", factor * std::stod(words_of(line)[k]) + more));
    }

  private:
    static void cut(Lines& dump, std::size_t frames) {
        std::size_t seen = 0;
        for (std::size_t at = 0; at < dump.size(); ++at) {
            seen += dump[at] == "ITEM: TIMESTEP" ? 1 : 0;
            if (seen > frames) {
                dump.resize(at);
            }
        }
    }
    std::shared_ptr<scratch::Folder> folder_ = std::make_shared<scratch::Folder>(); // copies write to the same
};

} // namespace series
