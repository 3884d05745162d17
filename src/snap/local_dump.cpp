// Reads rows of pairs: LAMMPS dumps of style local, and tables.
#include "snap/frame_file.hpp"

#include <algorithm>
#include <map>

namespace isostat::compare {

namespace {

/// The pairs of one frame.
class Pairs {
  public:
    Pairs(const FrameFile& file, const FileFrame& frame, const PairColumns& columns, const std::vector<long>& ids)
        : names_(frame.header.names), first_(file.column(frame, columns.first)),
          second_(file.column(frame, columns.second)) {
        for (const std::string& name : columns.force) {
            force_.push_back(file.column(frame, name));
        }
        for (std::size_t i = 0; i < ids.size(); ++i) {
            disk_of_.emplace(ids[i], static_cast<int>(i));
        }
    }

    void add(const TextLine& line) {
        const int i = disk(line, first_), j = disk(line, second_);
        if (i == j) {
            line.fail(line.field(second_), "second id", "another disk than the first");
        }
        PairForce pair{std::min(i, j), std::max(i, j), {}, line.number()};
        for (std::size_t a = 0; a < force_.size(); ++a) {
            const double force = line.number(force_[a], names_[force_[a]]);
            pair.force[a] = force_.size() > 1 && j < i ? -force : force;
        }
        if (pair.force != PerAxis<double>{}) {
            pairs_.push_back(pair);
        }
    }

    std::vector<PairForce> take() { return std::move(pairs_); }

  private:
    [[nodiscard]] int disk(const TextLine& line, std::size_t at) const {
        const auto found = disk_of_.find(line.integer(at, names_[at], 0, 1L << 62));
        if (found == disk_of_.end()) {
            line.fail(line.field(at), names_[at], "the id of a disk");
        }
        return found->second;
    }

    std::vector<std::string> names_;
    std::size_t first_, second_;
    std::vector<std::size_t> force_;
    std::map<long, int> disk_of_;
    std::vector<PairForce> pairs_;
};

} // namespace

std::vector<PairForce> read_local_dump(const std::filesystem::path& path, const PairColumns& columns,
                                       const std::vector<long>& ids, std::optional<long> frame) {
    FrameFile file(path.string(), "ENTRIES");
    std::optional<FileFrame> found;
    long number = 0;
    for (auto next = file.next(); next && number <= frame.value_or(number); next = file.next(), ++number) {
        found = std::move(next);
    }
    if (!found || (frame && number <= *frame)) {
        file.fail("the file ends after {} frames: expected frame {} (from 0)", number, frame.value_or(0));
    }
    Pairs pairs(file, *found, columns, ids);
    for (const TextLine& row : found->rows) {
        pairs.add(row);
    }
    return pairs.take();
}

} // namespace isostat::compare
