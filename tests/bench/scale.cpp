// The command-line program on large packings: CPU time and memory of the preparation, of an inspection, of a
// certificate, of its verification and of a stretch of trajectory (per arc, its equilibria included), and their growth
// with n. Every stage is a process of its own; its CPU time (all threads, user and system) and its largest resident
// memory are what the operating system counted. The status is 1 when a stage did not end as it should. Usage:
//   bench_scale [--json FILE] [--isostat PROGRAM] [--work DIR] [--threads T] [--equilibria E] [--arcs A] [n | FILE ...]
// A number of disks is prepared with seed 1 (its state stays in DIR), a state file is taken as it is.
#include "bench/shared/report.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

struct Settings {
    std::string isostat = "./isostat";
    std::filesystem::path work = "scale";
    int threads = 1;
    int equilibria = 5;
    int arcs = 60;
};

/// What a process took.
struct Cost {
    int status = -1;
    double cpu = 0, wall = 0; ///< s
    double memory = 0;        ///< bytes
};

double seconds(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

Cost measure(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    Cost cost;
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
        if (std::freopen("/dev/null", "w", stdout) != nullptr) {
            execvp(arguments[0], arguments.data());
        }
        _exit(127);
    }
    rusage usage{};
    int status = 0;
    if (child < 0 || wait4(child, &status, 0, &usage) != child) {
        return cost;
    }
    cost.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    cost.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    cost.memory = 1024 * static_cast<double>(usage.ru_maxrss);
    return cost;
}

/// Lines of the record of a run that tell of an arc.
long arcs_of(const std::filesystem::path& run) {
    std::ifstream in(run / "events.jsonl");
    long count = 0;
    for (std::string line; std::getline(in, line);) {
        count += line.find("\"opened\":") != std::string::npos ? 1 : 0;
    }
    return count;
}

std::string scene_of_run(const Settings& settings, const std::filesystem::path& state, const std::string& level) {
    return fmt::format("[packing]\nfile = \"{}\"\n[[programme]]\ndo = \"up\"\nequilibria = {}\n[run]\nmax_arcs = "
                       "{}\ncertify = \"{}\"\n[output]\npictures = false\n",
                       state.filename().string(), settings.equilibria, settings.arcs, level);
}

/// Rows of the table; growth against the size before.
class Scale {
  public:
    explicit Scale(bench::Table& table) : table_(table) {}

    /// `parts`: what the CPU time is shared out among (arcs), or 1.
    void add(int n, const std::string& stage, const Cost& cost, double parts, const std::string& end) {
        const double share = cost.cpu / parts;
        bench::Cell time = std::monostate();
        bench::Cell memory = std::monostate();
        if (const auto before = last_.find(stage); before != last_.end() && before->second.n != n) {
            const double factor = std::log(static_cast<double>(n) / before->second.n);
            time = std::log(share / before->second.share) / factor;
            memory = std::log(cost.memory / before->second.memory) / factor;
        }
        last_[stage] = {n, share, cost.memory};
        table_.add({static_cast<long>(n), stage, share, 1e3 * share / n, time, cost.memory / 1e6, cost.memory / 1e3 / n,
                    memory, cost.wall / parts, end});
        fmt::print(stderr, "{} disks, {}: {:.2f} s CPU, {:.0f} MB, {}\n", n, stage, share, cost.memory / 1e6, end);
    }

  private:
    struct Last {
        int n;
        double share, memory;
    };
    bench::Table& table_;
    std::map<std::string, Last> last_;
};

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    std::string work = settings.work.string();
    std::vector<std::string> sources{"400", "1936"};
    bench::Program program("bench_scale", "cost of the command-line program against the size of the packing");
    program.option("--isostat", settings.isostat, "the program");
    program.option("--work", work, "folder for states and runs");
    program.option("--threads", settings.threads, "threads of the program");
    program.option("--equilibria", settings.equilibria, "of the stretch of trajectory, at most");
    program.option("--arcs", settings.arcs, "of one rearrangement, at most (then the stretch ends)");
    program.words("sources", sources, "numbers of disks, or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    settings.work = work;
    std::filesystem::create_directories(settings.work);
    const std::string threads = std::to_string(settings.threads);
    bench::Table table(
        "scale",
        fmt::format("The program on one sample of each size, {} thread(s); CPU time of all threads, largest "
                    "resident memory, exponents against the size before:",
                    settings.threads),
        {{"n", "n", ""},
         {"stage", "stage", ""},
         {"cpu", "CPU, s", "s, all threads", "{:.3g}"},
         {"cpu_per_disk", "CPU per disk, ms", "ms", "{:.3g}"},
         {"cpu_exponent", "CPU grows as n to the power of", "", "{:.2f}"},
         {"memory", "memory, MB", "MB", "{:.0f}"},
         {"memory_per_disk", "memory per disk, kB", "kB", "{:.2f}"},
         {"memory_exponent", "memory grows as n to the power of", "", "{:.2f}"},
         {"wall", "wall, s", "s wall", "{:.3g}"},
         {"end", "end", ""}});
    Scale scale(table);
    bool good = true;
    const auto verdict = [&good](const Cost& cost, bool fine) {
        good = good && fine;
        return fine ? std::string("done") : fmt::format("exit status {}", cost.status);
    };
    for (const std::string& source : sources) {
        std::filesystem::path state = source;
        if (source.find_first_not_of("0123456789") == std::string::npos) {
            const std::filesystem::path scene = settings.work / (source + ".toml");
            std::ofstream(scene) << fmt::format("[packing]\ndisks = {}\nseed = 1\n[[programme]]\ndo = "
                                                "\"up\"\nequilibria = 1\n",
                                                source);
            state = settings.work / (source + ".json");
            const Cost cost = measure({settings.isostat, "prepare", scene, "-o", state, "-q", "--threads", threads});
            scale.add(std::atoi(source.c_str()), "preparation", cost, 1, verdict(cost, cost.status == 0));
            if (cost.status != 0) {
                continue;
            }
        }
        const int n = isostat::read_state(state).state.packing.disk_count();
        const Cost inspection = measure({settings.isostat, "inspect", state, "--json", "--threads", threads});
        scale.add(n, "inspection", inspection, 1, verdict(inspection, inspection.status == 0));
        const std::filesystem::path certificate = settings.work / "certificate.json";
        const Cost certified =
            measure({settings.isostat, "certify", state, "-o", certificate, "--json", "--threads", threads});
        scale.add(n, "certificate", certified, 1, verdict(certified, certified.status == 0));
        const Cost verified = measure({settings.isostat, "verify", certificate, "--json"});
        scale.add(n, "verification", verified, 1, verdict(verified, verified.status == 0));
        for (const std::string level : {"decisions"}) {
            const std::filesystem::path scene = settings.work / "run.toml";
            if (!std::filesystem::exists(settings.work / state.filename())) {
                std::filesystem::copy_file(state, settings.work / state.filename());
            }
            std::ofstream(scene) << scene_of_run(settings, state, level);
            const std::filesystem::path run = settings.work / ("run-" + level);
            const Cost cost =
                measure({settings.isostat, "run", scene, "-o", run, "--force", "-q", "--threads", threads});
            const long arcs = arcs_of(run);
            // A rearrangement longer than --arcs ends the run with its own status: the stretch is as good.
            const bool fine = arcs > 0 && (cost.status == 0 || arcs >= settings.arcs);
            scale.add(n, "an arc, " + level, cost, static_cast<double>(std::max(1L, arcs)),
                      fmt::format("{}, {} arcs", verdict(cost, fine), arcs));
        }
    }
    program.show(table);
    return program.finish(good);
}
