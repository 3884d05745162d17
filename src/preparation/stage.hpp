#pragma once
/// \file
/// Book-keeping of one stage: clocks, progress, entry in the report.

#include <isostat/preparation/preparation.hpp>

#include <chrono>
#include <ctime>
#include <string>
#include <utility>

namespace isostat::preparation {

/// Measures a stage from construction to `finish`.
class Stage {
  public:
    Stage(std::string name, const PreparationOptions& options)
        : name_(std::move(name)), options_(&options), wall_(std::chrono::steady_clock::now()), cpu_(std::clock()) {
        progress(0, "");
    }

    void progress(double fraction, const std::string& text) const {
        if (options_->progress) {
            options_->progress({name_, fraction, text});
        }
    }

    /// The entry, with times and name filled in; the caller adds the figures.
    [[nodiscard]] PreparationStage finish() const {
        PreparationStage stage;
        stage.name = name_;
        stage.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
        stage.cpu_seconds = static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC;
        progress(1, "");
        return stage;
    }

  private:
    std::string name_;
    const PreparationOptions* options_;
    std::chrono::steady_clock::time_point wall_;
    std::clock_t cpu_;
};

} // namespace isostat::preparation
