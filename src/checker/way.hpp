#pragma once
/// \file
/// Proof that an arc leads from one vertex to the next without another event (proofs/checker.md, K16 to K20).

#include "checker/replay.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// A line of certificates/arcs.jsonl, which helps the checker and proves nothing. Coordinates are the moving degrees of
/// freedom, in their order.
struct Witness {
    struct Centre {
        int held = 0;
        std::vector<double> q;
    };
    std::optional<std::vector<int>> grains; ///< grains that move; absent: all
    std::vector<Centre> centres;
    std::vector<double> end;
};

/// The lines of certificates/arcs.jsonl.
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

/// One arc as its record and its witness describe it.
struct Way {
    std::size_t opened = 0; ///< position in the contact list
    int direction = +1;     ///< -1: a held coordinate that falls
    bool rattles = false;   ///< the power is that of the infinitesimal loads
    bool at_limit = false;  ///< the power grows from 0
    double stress = 0;      ///< on the loaded axis
    const Witness& witness;
    bool end_only = false; ///< of gaps and power, only the quantity that ends the arc is checked
};

/// The state in which the arc ends according to the witness: its contacts are those of `from`, the opened one replaced.
/// An objection when the witness does not fit the arc.
Objections end_of(const Place& from, const Contact& closed, const Way& way, State& end);

/// Empty result: it is proved that from the true vertex of `from` the kept contacts define one curve on the side on
/// which the opened contact opens; it reaches the true vertex of `to`; strictly between the two every other gap is
/// positive, and so is the power of the load, except on a hundredth of the first piece at a limit and of the last piece
/// before a power turn. Otherwise the unproved part, which is never a refutation.
Objections prove_way(const Place& from, const Place& to, const Way& way);

/// Empty result: the curve of the kept contacts leads from the true vertex of `from` to that of `to`, and before it
/// neither the gap of the contact that closes there returns to 0 nor, at a power turn, the power vanishes. An arc that
/// ends as recorded can then only end there, so a contradiction to the record there refutes it. Other pairs may overlap
/// before (then the record is wrong too). Otherwise the unproved part. `way.witness` may be empty.
Objections prove_end(const Place& from, const Place& to, Way way);

} // namespace isostat::checker
