#include "compare/local.hpp"

#include "compare/path.hpp"
#include "core/parallel.hpp"

#include <cstddef>
#include <string>

namespace isostat::compare {

namespace {

std::string outcome(const JudgedFrame& before, const JudgedFrame& after, const RunOptions& options) {
    const FrameResult& r = after.result;
    if (!before.state || r.status == FrameStatus::file || r.status == FrameStatus::moving) {
        return {};
    }
    const auto list = list_after(*before.state, r.stress, false, options);
    return !list.ok()                   ? "undecided: " + list.failure().message(before.state->packing.dimension)
           : list.value() == after.list ? "same"
                                        : "other";
}

} // namespace

void compare_with_frame_before(std::vector<JudgedFrame>& frames, std::size_t first, const RunOptions& options) {
    parallel_pieces(frames.size() - first, [&](std::size_t k) {
        if (const std::size_t at = first + k; at > 0) {
            frames[at].result.local = outcome(frames[at - 1], frames[at], options);
        }
    });
}

} // namespace isostat::compare
