#include "bench/shared/stretch.hpp"

#include "bench/shared/references.hpp"
#include "support/segments.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

using namespace isostat;

namespace bench {

std::optional<State> start(const std::string& source, int dimension) {
    if (source.find_first_not_of("0123456789:") != std::string::npos) {
        return dimension == plane ? read_state(source).state : read_any_state(source, Dimensions::any).state;
    }
    PreparationOptions options{.dimension = dimension, .disks = std::atoi(source.c_str())};
    if (const std::size_t colon = source.find(':'); colon != std::string::npos) {
        options.seed = std::strtoull(source.c_str() + colon + 1, nullptr, 10);
    }
    PreparationReport report;
    auto prepared = prepare(options, report);
    if (!prepared.ok()) {
        fmt::print(stderr, "{}: not prepared: {}\n", source, prepared.failure().message());
        return std::nullopt;
    }
    return prepared.value();
}

namespace {

class Watcher final : public RunObserver {
  public:
    Watcher(const StretchOptions& options, Stretch& stretch) : options_(options), stretch_(stretch) {}
    void on_arc(const ArcRecord& arc) override {
        stretch_.arcs.push_back(arc);
        if (options_.arcs > 0 && arc.step >= options_.arcs) {
            stop = true;
        }
    }
    void on_equilibrium(const EquilibriumRecord&, const State& state, const std::vector<double>&) override {
        const double begin = time(), process_begin = process_milliseconds();
        constexpr int equilibria_between = 10; // one measurement of the units and the next
        if (seen_++ % equilibria_between == 0) {
            const auto matrix = matrix_of(state);
            klu.add(milliseconds([&] { bench::klu(matrix); }).median());
            umfpack.add(milliseconds([&] { bench::umfpack(matrix, order_of(state)); }).median());
        }
        if (options_.visit) {
            options_.visit(state);
        }
        lost += time() - begin;
        process_lost += process_milliseconds() - process_begin;
    }
    [[nodiscard]] double time() const { return options_.threads > 1 ? wall_milliseconds() : cpu_milliseconds(); }

    Sample klu, umfpack;
    double lost = 0, process_lost = 0;
    std::atomic<bool> stop = false;

  private:
    const StretchOptions& options_;
    Stretch& stretch_;
    int seen_ = 0;
};

template <class Number> Sample collect(const std::vector<Stretch>& runs, Number Stretch::*member) {
    Sample out;
    for (const Stretch& run : runs) {
        out.add(run.*member);
    }
    return out;
}

} // namespace

Stretch run_stretch(const State& from, const StretchOptions& options) {
    Stretch out;
    Watcher watcher(options, out);
    State state = from;
    RunOptions run{.certify = options.level, .stop = &watcher.stop};
    set_threads(options.threads);
    const double begin = watcher.time();
    const double process_begin = process_milliseconds();
    const SegmentOutcome outcome = run_segment(state, towards(options.equilibria), 0, run, out.counters, watcher);
    const auto arcs = static_cast<double>(std::max(1L, out.counters.steps));
    out.milliseconds_per_arc = (watcher.time() - begin - watcher.lost) / arcs;
    out.cpu_per_arc = (process_milliseconds() - process_begin - watcher.process_lost) / arcs;
    set_threads(1);
    out.klu = watcher.klu.median();
    out.umfpack = watcher.umfpack.median();
    if (outcome.failure && outcome.failure->kind != FailureKind::interrupted) {
        out.failure = outcome.failure->message();
    }
    return out;
}

Sample Stretches::per_arc() const {
    return collect(runs, &Stretch::milliseconds_per_arc);
}
Sample Stretches::cpu_per_arc() const {
    return collect(runs, &Stretch::cpu_per_arc);
}
Sample Stretches::klu() const {
    return collect(runs, &Stretch::klu);
}
Sample Stretches::umfpack() const {
    return collect(runs, &Stretch::umfpack);
}

} // namespace bench
