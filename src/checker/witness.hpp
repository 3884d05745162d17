#pragma once
/// \file
/// certificates/arcs.jsonl: where the checker is told to look.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// Coordinates are those that are degrees of freedom and move, in their order.
struct Witness {
    struct Centre {
        int held = 0;
        std::vector<double> q;
    };
    std::optional<std::vector<int>> grains; ///< that move; none: all
    std::vector<Centre> centres;
    std::vector<double> end;
};

class Witnesses {
  public:
    Witnesses() = default;
    /// Notes where the line of each arc begins; a file that is not there has none. Throws `Error(bad_input)`.
    explicit Witnesses(std::filesystem::path file);
    /// Of the arc with this step; nothing: there is no line, or the run had nothing to say. Throws `Error(bad_input)`.
    [[nodiscard]] std::optional<Witness> of(long step) const;

  private:
    std::filesystem::path file_;
    std::map<long, std::pair<long, int>> begin_; ///< by step: byte and line
};

} // namespace isostat::checker
