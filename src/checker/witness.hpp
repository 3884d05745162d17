#pragma once
/// \file
/// certificates/arcs.jsonl: hints for the checker.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// Coordinates are the moving degrees of freedom, in their order.
struct Witness {
    struct Centre {
        int held = 0;
        std::vector<double> q;
    };
    std::optional<std::vector<int>> grains; ///< grains that move; absent: all
    std::vector<Centre> centres;
    std::vector<double> end;
};

class Witnesses {
  public:
    Witnesses() = default;
    /// Notes where the line of each arc begins; a missing file has no lines. Throws `Error(bad_input)`.
    explicit Witnesses(std::filesystem::path file);
    /// The witness of the arc with this step; nothing: no line, or an empty one. Throws `Error(bad_input)`.
    [[nodiscard]] std::optional<Witness> of(long step) const;

  private:
    std::filesystem::path file_;
    std::map<long, std::pair<long, int>> begin_; ///< by step: byte and line
};

} // namespace isostat::checker
