#pragma once
/// \file
/// Book-keeping of one stage: clocks, progress, entry in the report.

#include <isostat/preparation/preparation.hpp>

#include <chrono>
#include <ctime>
#include <string>
#include <utility>

namespace isostat::preparation {

/// Wall clock and processor time since construction.
class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    }
    [[nodiscard]] double cpu_seconds() const { return static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC; }

  private:
    std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
    std::clock_t cpu_ = std::clock();
};

/// The time of a stage, from construction to `finish`.
class Stage {
  public:
    Stage(std::string name, const PreparationOptions& options) : name_(std::move(name)), options_(&options) {
        progress(0, "");
    }

    void progress(double fraction, const std::string& text) const {
        if (options_->progress) {
            options_->progress({name_, fraction, text});
        }
    }

    /// The entry with name and times; the caller adds further figures.
    [[nodiscard]] PreparationStage finish(bool completed, long iterations, int contacts, double solid_fraction) const {
        PreparationStage stage;
        stage.completed = completed;
        stage.iterations = iterations;
        stage.contacts = contacts;
        stage.solid_fraction = solid_fraction;
        stage.name = name_;
        stage.seconds = watch_.seconds();
        stage.cpu_seconds = watch_.cpu_seconds();
        progress(1, "");
        return stage;
    }

  private:
    std::string name_;
    const PreparationOptions* options_;
    Stopwatch watch_;
};

} // namespace isostat::preparation
