#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#ifdef ISOSTAT_WITH_MPI
#include "cli/mpi/sample_queue.hpp"
#endif

#include "core/refuse.hpp"
#include "ensemble/ensemble.hpp"
#include "ensemble/processes.hpp"
#include "io/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <thread>

namespace isostat::cli {

namespace {

std::unique_ptr<SampleQueue> make_queue(std::size_t count) {
#ifdef ISOSTAT_WITH_MPI
    // Set by mpirun and similar programs. Without these MPI would only start a helper process.
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
        if (std::getenv(variable) != nullptr) { // NOLINT(concurrency-mt-unsafe): one thread
            return std::make_unique<MpiQueue>(count);
        }
    }
#endif
    return std::make_unique<LocalQueue>(count);
}

/// The last line of a log, which `isostat run` printed.
std::string last_words(const std::filesystem::path& log) {
    std::string text;
    try {
        text = read_text(log);
    } catch (const Error&) {
        return "it said nothing";
    }
    while (!text.empty() && text.back() == '\n') {
        text.pop_back();
    }
    return text.substr(text.rfind('\n') + 1);
}

/// Notes how a process ended if its run could not.
void note_ending(const SampleFolders& folders, std::size_t number, const ProcessEnd& end) {
    const auto words = [&] { return last_words(folders.folder(number) / "log.txt"); };
    if (end.signal == -1) {
        folders.note(number, SampleStatus::refused,
                     fmt::format("the process could not be started: {}", std::strerror(end.status)));
    } else if (end.signal == SIGTERM || end.signal == SIGINT) {
        folders.note(number, SampleStatus::interrupted, "stopped by a signal");
    } else if (end.signal != 0) {
        folders.note(number, SampleStatus::crashed,
                     fmt::format("killed by signal {} ({})", end.signal, strsignal(end.signal)));
    } else if (end.status == Error(ErrorKind::internal, "").exit_status()) {
        folders.note(number, SampleStatus::crashed, words());
    } else if (end.status != done && end.status != failed && end.status != undecided && end.status != interrupted) {
        folders.note(number, SampleStatus::refused, fmt::format("exit status {}: {}", end.status, words()));
    }
}

/// Progress for a person: a row per sample that ended, and one line that is rewritten.
class Board {
  public:
    Board(const SampleFolders& folders, int workers, bool quiet)
        : folders_(folders), workers_(workers), quiet_(quiet), line_(quiet) {}

    void started(std::size_t number) { running_.insert(number); }
    void ended(std::size_t number) {
        running_.erase(number);
        const Sample sample = folders_.sample(number);
        ++done_;
        if (!sample.finished()) {
            ++broken_;
        }
        if (sample.status == SampleStatus::failed) {
            ++failed_;
        }
        if (quiet_) {
            return;
        }
        line_.clear();
        if (done_ == 1) {
            say("{:>8} {:<12} {:>10} {:>8} {:>9} {:>8} {:>8}\n", "seed", "status", "equilibria", "arcs", "seconds",
                "elapsed", "rest");
        }
        say("{:>8} {:<12} {:>10} {:>8} {:>9.2f} {:>8} {:>8} {}\n", sample.seed, to_string(sample.status),
            sample.equilibria, sample.arcs, sample.seconds, clock_text(pace_.elapsed()), clock_text(rest()),
            sample.reason);
        std::fflush(stdout);
    }
    /// Counts a sample finished in an earlier call.
    void found() { ++found_; }
    void show() {
        const auto seed = [&](std::size_t number) { return folders_.seed(number); };
        std::string seeds;
        for (const std::size_t number : running_) {
            seeds += fmt::format(" {}", seed(number));
        }
        line_.show(fmt::format("{} of {} samples done{}{}, running{}, elapsed {}, rest {}", found_ + done_,
                               folders_.header().samples, failed_ > 0 ? fmt::format(", {} failed", failed_) : "",
                               broken_ > 0 ? fmt::format(", {} broken off", broken_) : "", seeds,
                               clock_text(pace_.elapsed()), clock_text(rest())));
    }
    void clear() { line_.clear(); }

  private:
    /// Estimate from the mean time of ended samples; running ones count as half done.
    [[nodiscard]] double rest() const {
        const int open = folders_.header().samples - found_ - done_;
        const double half = std::min(0.5 * workers_, 0.5 * open);
        return done_ == 0 ? -1 : pace_.rest(done_ + half, open - half);
    }
    const SampleFolders& folders_;
    int workers_;
    bool quiet_;
    StatusLine line_;
    Pace pace_;
    std::set<std::size_t> running_;
    int done_ = 0;
    int found_ = 0;
    int failed_ = 0;
    int broken_ = 0;
};

/// Runs the samples of this rank; on rank 0 `board` shows those of all ranks.
void work(const SampleFolders& folders, SampleQueue& queue, int jobs, Board* board) {
    std::set<std::size_t> mine;
    const auto command_of = [&](std::size_t number) -> std::optional<Command> {
        if (folders.sample(number).finished()) {
            return std::nullopt;
        }
        std::vector<std::string> arguments{"run",     (folders.folder(number) / "scene.toml").string(),
                                           "-o",      folders.folder(number).string(),
                                           "--quiet", "--threads",
                                           "1"}; // one core each
        if (folders.prepare(number)) {
            arguments.emplace_back("--resume");
        }
        mine.insert(number);
        return Command{std::filesystem::read_symlink("/proc/self/exe"), arguments, folders.folder(number) / "log.txt"};
    };
    const auto on_start = [&](std::size_t number) {
        if (board != nullptr) {
            board->started(number);
        }
    };
    const auto on_end = [&](std::size_t number, const ProcessEnd& end) { note_ending(folders, number, end); };
    const auto on_wait = [&] {
        if (board != nullptr) {
            board->show();
        }
    };
    run_processes(queue, jobs, stop_flag(), command_of, on_start, on_end, on_wait);
}

int default_jobs(int ranks) {
    return ranks > 1 ? 1 : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

int exit_status(const std::vector<Sample>& samples) {
    const auto any = [&](SampleStatus status) {
        return std::ranges::any_of(samples, [&](const Sample& s) { return s.status == status; });
    };
    if (any(SampleStatus::interrupted) || any(SampleStatus::missing)) {
        return interrupted;
    }
    if (any(SampleStatus::failed) || any(SampleStatus::crashed) || any(SampleStatus::refused)) {
        return failed;
    }
    return any(SampleStatus::undecided) ? undecided : done;
}

void print_outcome(const std::filesystem::path& path, const std::vector<Sample>& samples, bool json) {
    std::map<std::string, int> counts;
    long equilibria = 0;
    long proved = 0;
    long arcs = 0;
    for (const Sample& sample : samples) {
        ++counts[to_string(sample.status)];
        equilibria += sample.equilibria;
        proved += sample.proved;
        arcs += sample.arcs;
    }
    if (json) {
        Json object;
        object["directory"] = path.string();
        object["samples"] = samples.size();
        object["counts"] = counts;
        object["equilibria"] = equilibria;
        object["proved"] = proved;
        object["arcs"] = arcs;
        print_json(object);
        return;
    }
    std::string words;
    for (const auto& [word, count] : counts) {
        words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, word);
    }
    say("{} samples: {}; {} equilibria, {} of them proved, {} arcs\n"
        "tables: equilibria.csv, increments.csv, samples.csv in {}\n",
        samples.size(), words, equilibria, proved, arcs, path.string());
}

int run_and_merge(const EnsembleArguments& arguments, const EnsembleHeader& header, SampleQueue& queue) {
    const bool quiet = arguments.common.quiet || arguments.common.json;
    const EnsembleDirectory directory(arguments.output, header, mode_of(arguments));
    const int jobs = arguments.jobs.value_or(default_jobs(queue.ranks()));
    Board board(directory.samples(), jobs * queue.ranks(), quiet);
    std::vector<bool> was_finished;
    for (std::size_t k = 0; k < static_cast<std::size_t>(header.samples); ++k) {
        was_finished.push_back(directory.samples().sample(k).finished());
        if (was_finished.back()) {
            board.found();
        }
    }
    queue.on_done = [&](std::size_t number) {
        if (!was_finished[number]) {
            board.ended(number);
        }
    };
    if (!quiet) {
        say("{} samples, seeds {} to {}, {} at a time{}\n", header.samples, header.first_seed,
            header.first_seed + static_cast<std::uint64_t>(header.samples) - 1, jobs * queue.ranks(),
            queue.ranks() > 1 ? fmt::format(" on {} ranks", queue.ranks()) : "");
        std::fflush(stdout);
    }
    work(directory.samples(), queue, jobs, &board);
    queue.finish();
    board.clear();
    const std::vector<Sample> samples = directory.merge();
    if (!quiet || arguments.common.json) {
        print_outcome(directory.samples().path(), samples, arguments.common.json);
    }
    for (const Sample& sample : samples) {
        const bool left = sample.status == SampleStatus::interrupted || sample.status == SampleStatus::missing;
        if (sample.status != SampleStatus::completed && !left) { // the counts tell how many are left out
            say(stderr, "isostat: seed {}: {}: {}\n", sample.seed, to_string(sample.status), sample.reason);
        }
    }
    const int status = exit_status(samples);
    if (status == interrupted) {
        say(stderr, "isostat: to go on: the same command with --resume\n");
    }
    return status;
}

} // namespace

int ensemble(const EnsembleArguments& arguments) {
    const auto queue = make_queue(static_cast<std::size_t>(arguments.samples));
    EnsembleHeader header;
    header.program = program_name();
    header.command = arguments.common.command;
    header.scene = arguments.scene;
    header.first_seed = arguments.first_seed;
    header.samples = arguments.samples;
    try {
        const Scene scene = read_scene(arguments.scene);
        if (scene.programme.empty()) {
            refuse(arguments.scene, "has no [[programme]]: expected at least one segment to run");
        }
        header.scene_text = scene.text;
        catch_interrupts();
        if (queue->rank() == 0) {
            return run_and_merge(arguments, header, *queue);
        }
        work(SampleFolders(arguments.output, header), *queue, arguments.jobs.value_or(1), nullptr);
        queue->finish();
        return done;
    } catch (...) {
        queue->stop(); // no rank waits for this one
        queue->finish();
        throw;
    }
}

} // namespace isostat::cli
