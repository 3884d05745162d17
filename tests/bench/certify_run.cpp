// Certifies every equilibrium of the programmes of scenes: how many, in which arithmetic, which not and why, and the
// cost of a full certificate in units of one UMFPACK analysis + factorisation of the same matrix (CPU time, medians,
// same run). Usage:
//   bench_certify_run [--first K] [scene.toml | state ...]
//     a scene: prepared and run as its programme says; --first K stops after K equilibria of each segment
//     a state file or vertex text: certified as it is (cost only)
#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/isostatic.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>
#include <umfpack.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

using namespace isostat;

namespace {

double cpu_milliseconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

template <class Work> double milliseconds(Work work) {
    const double begin = cpu_milliseconds();
    work();
    return cpu_milliseconds() - begin;
}

template <class Work> double median_milliseconds(Work work, int repeats) {
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        times.push_back(milliseconds(work));
    }
    std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
    return times[static_cast<std::size_t>(repeats / 2)];
}

double umfpack_milliseconds(const State<2>& state) {
    const sparse::Matrix<double> h = contact_matrix(state.packing, DofMap<2>(state.packing), state.contacts);
    return median_milliseconds(
        [&] {
            void* symbolic = nullptr;
            void* numeric = nullptr;
            umfpack_di_symbolic(h.rows, h.cols, h.start.data(), h.row.data(), h.value.data(), &symbolic, nullptr,
                                nullptr);
            umfpack_di_numeric(h.start.data(), h.row.data(), h.value.data(), symbolic, &numeric, nullptr, nullptr);
            umfpack_di_free_numeric(&numeric);
            umfpack_di_free_symbolic(&symbolic);
        },
        9);
}

void cost(const std::string& name, const State<2>& state) {
    const double umfpack = umfpack_milliseconds(state);
    Certification c;
    const double full = median_milliseconds([&] { c = certify(state); }, 9);
    CertifyOptions in_double;
    in_double.highest = Rung::double_bound;
    const double cheap = median_milliseconds([&] { (void)certify(state, in_double); }, 9);
    fmt::print("{:<24} N = {:>5}: certificate {:.2f} ms ({}), double only {:.2f} ms, UMFPACK {:.2f} ms: ratio {:.2f}\n",
               name, state.contacts.size(), full, to_string(c.verdict), cheap, umfpack, full / umfpack);
    for (const std::string& reason : c.claims.undecided) {
        fmt::print("    {}\n", reason);
    }
}

/// Certifies what it is handed; the state is printed with 17 digits and read back first, as a user's would be.
class Certifier final : public RunObserver<2> {
  public:
    void on_equilibrium(const EquilibriumRecord<2>& record, const State<2>& state,
                        const std::vector<double>&) override {
        const State<2> stored = parse_state<2>(state_text(state), "state").state;
        Certification c;
        const double time = milliseconds([&] { c = certify(stored); });
        ++count;
        total += time;
        slowest = std::max(slowest, time);
        proved += c.verdict == Verdict::proved ? 1 : 0;
        const CertificateClaims& claims = c.claims;
        if (claims.vertex) {
            widest_radius = std::max(widest_radius, claims.vertex->radius);
            ++vertex[claims.vertex->rung];
        }
        if (claims.forces) {
            ++forces[claims.forces->rung];
        }
        if (claims.gaps) {
            ++gaps[claims.gaps->rung];
        }
        if (claims.load_interval) {
            ++interval[claims.load_interval->rung];
            const LoadIntervalClaim& i = *claims.load_interval;
            agree += i.low.opens == record.opens_low && i.high.opens == record.opens_high ? 1 : 0;
        }
        smallest_sigma = std::min(smallest_sigma, c.smallest_sigma);
        for (const std::string& reason : claims.undecided) {
            fmt::print("    equilibrium {}: {}\n", record.number, reason);
        }
        keep[record.number] = state;
    }

    int count = 0, proved = 0, agree = 0;
    double total = 0, slowest = 0, widest_radius = 0, smallest_sigma = 1e300;
    std::map<Rung, int> vertex, forces, gaps, interval;
    std::map<int, State<2>> keep;
};

std::string tally(const std::map<Rung, int>& counts) {
    std::string text;
    for (const auto& [rung, count] : counts) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(rung));
    }
    return text;
}

int play(const std::string& file, std::optional<int> first) {
    const Scene scene = read_scene(file);
    PreparationReport<2> report;
    auto prepared = prepare<2>(scene.preparation, report);
    if (!prepared.ok()) {
        fmt::print("{}: not prepared: {}\n", file, prepared.failure().message);
        return 1;
    }
    State<2> state = prepared.value();
    fmt::print("{}: n = {}\n", file, state.packing.disk_count());
    cost("    start", state);
    Certifier certifier;
    RunCounters counters;
    int number = 0;
    double run_time = 0;
    for (const ProgrammeStep& step : scene.programme) {
        if (step.from) {
            const auto start = certifier.keep.find(*step.from);
            if (start == certifier.keep.end()) {
                continue;
            }
            state = start->second;
        }
        Segment segment = segment_of(step, state.load.stress[0], state.load.stress[1], file);
        if (first) {
            segment.equilibria = std::min(*first, segment.equilibria.value_or(*first));
        }
        const double before = certifier.total;
        SegmentOutcome outcome;
        run_time +=
            milliseconds([&] { outcome = run_segment<2>(state, segment, number++, scene.run, counters, certifier); });
        run_time -= certifier.total - before;
        if (!outcome.completed) {
            fmt::print("    segment {}: {}\n", number - 1, outcome.failure->message);
        }
    }
    fmt::print("    {} equilibria, {} certified, {} with the opening contacts of the run; radius <= {:.2g}, sigma_min "
               ">= {:.2g}\n",
               certifier.count, certifier.proved, certifier.agree, certifier.widest_radius, certifier.smallest_sigma);
    fmt::print("    vertex: {}; forces: {}; gaps: {}; load interval: {}\n", tally(certifier.vertex),
               tally(certifier.forces), tally(certifier.gaps), tally(certifier.interval));
    fmt::print("    certificates: mean {:.2f} ms, slowest {:.2f} ms; all {:.2f} s, the run itself {:.2f} s\n",
               certifier.total / std::max(1, certifier.count), certifier.slowest, 1e-3 * certifier.total,
               1e-3 * run_time);
    std::fflush(stdout);
    return certifier.proved == certifier.count ? 0 : 2;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> inputs(argv + 1, argv + argc);
    std::optional<int> first;
    if (inputs.size() > 1 && inputs[0] == "--first") {
        first = std::atoi(inputs[1].c_str());
        inputs.erase(inputs.begin(), inputs.begin() + 2);
    }
    int status = 0;
    for (const std::string& input : inputs) {
        if (input.ends_with(".toml")) {
            status = std::max(status, play(input, first));
        } else {
            cost(input.substr(input.find_last_of('/') + 1), read_state<2>(input).state);
        }
    }
    return status;
}
