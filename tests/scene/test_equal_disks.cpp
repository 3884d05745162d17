// Samples of equal disks that ended elsewhere once, numerically: they go on to where their packings end.
#include "support/prepared.hpp"

#include <isostat/scene/scene.hpp>
#include <isostat/trajectory/trajectory.hpp>

using namespace isostat;

namespace {

/// Of a loading over 30 equilibria.
Failure end_of(const std::string& packing, const std::string& ties) {
    const Scene scene = parse_scene("[packing]\nlaw = \"equal\"\n" + packing + "[run]\nties = \"" + ties +
                                        "\"\n[[programme]]\ndo = \"up\"\nequilibria = 30\n",
                                    "s.toml", "");
    auto state = prepared(scene.preparation);
    RunCounters counters;
    RunObserver nobody;
    const auto outcome =
        run_segment(state, segment_of(scene.programme[0], state.load, "s.toml"), 0, scene.run, counters, nobody);
    return outcome.failure.value_or(Failure{FailureKind::interrupted, "completed"});
}

} // namespace

/// Ends that are nearly singular, to 1e-11: found with residuals in double-double.
BOOST_AUTO_TEST_CASE(nearly_equal_disks_are_followed_past_ends_that_are_nearly_singular) {
    for (const char* const seed : {"seed = 5\n", "seed = 17\n"}) {
        const Failure end = end_of(std::string("disks = 100\njitter = 1e-9\n") + seed, "stop");
        BOOST_TEST((end.kind == FailureKind::cap_reached), seed << end.message());
    }
}
