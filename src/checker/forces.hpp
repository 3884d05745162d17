#pragma once
/// \file
/// Forces at the true vertex (proofs/checker.md, K6) and what counting alone proves of them (K7, K8).

#include "checker/bounds.hpp"
#include "checker/vertex.hpp"

#include <isostat/packing/load.hpp>

#include <map>
#include <optional>
#include <vector>

namespace isostat::checker {

/// External forces per degree of freedom at the true vertex, most of which are 0.
class Forces {
  public:
    explicit Forces(std::size_t size = 0) : size_(size) {}
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool acts(std::size_t dof) const { return acting_.count(dof) > 0; }
    [[nodiscard]] Range operator[](std::size_t dof) const { return acts(dof) ? acting_.at(dof) : Range(); }
    void set(std::size_t dof, const Range& force) {
        acting_.erase(dof);
        if (force.lower != 0 || force.upper != 0) {
            acting_.emplace(dof, force);
        }
    }
    /// Those that are not 0.
    [[nodiscard]] const std::map<std::size_t, Range>& acting() const { return acting_; }

  private:
    std::size_t size_;
    std::map<std::size_t, Range> acting_;
};

inline Bounds bounds_of(const Range& range) {
    return {rounded_down(range.lower), rounded_up(range.upper)};
}

/// Ranges of the forces of all contacts. They are made when they are asked for, where they are integers of 128 bits
/// with one bound.
class ContactForces {
  public:
    ContactForces() = default;
    ContactForces(std::vector<Range> ranges) : ranges_(std::move(ranges)) {} // NOLINT: the same ranges
    /// Force l is (middle_l +- around) times the length `force_units` of the problem, which must outlive it, times
    /// 2^exponent.
    ContactForces(const Problem& problem, std::vector<Wide> middle, Wide around, long exponent)
        : problem_(&problem), middle_(std::move(middle)), around_(around), exponent_(exponent) {}
    operator std::vector<Range>() const; // NOLINT
    [[nodiscard]] std::size_t size() const { return middle_.size() + ranges_.size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }
    [[nodiscard]] Range operator[](std::size_t contact) const;
    [[nodiscard]] bool positive(std::size_t l) const {
        return middle_.empty() ? ranges_[l].positive() : middle_[l] > around_;
    }
    [[nodiscard]] bool has_zero(std::size_t l) const {
        return middle_.empty() ? ranges_[l].has_zero() : middle_[l] <= around_ && middle_[l] >= -around_;
    }
    /// Force l between doubles.
    [[nodiscard]] Bounds bounds(std::size_t l) const;

  private:
    const Problem* problem_ = nullptr;
    std::vector<Wide> middle_;
    Wide around_ = 0;
    long exponent_ = 0;
    std::vector<Range> ranges_; ///< where those are empty
};

/// A stress of an axis or tilt, as an exact number: on a path `at` + t `rate`.
Rational stress_of(const Load& load, std::size_t place);

/// The finite load of a state, its derivative with respect to the loaded stress, and the infinitesimal load.
Forces finite_load(const Problem& problem, const State& state, const TrueVertex& vertex);
Forces unit_load(const Problem& problem, const State& state, const TrueVertex& vertex);
Forces infinitesimal_load(const Problem& problem, const State& state);

/// Ranges of all contact forces (compressive positive) under a load.
ContactForces contact_forces(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                             const TrueVertex& vertex, const Forces& load);

/// The number of degrees of freedom without load that no contact outside a set touches. Along an axis without loads
/// what cannot move counts too, as long as its balance is independent of the counted ones.
int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

/// The forces of these contacts are exactly 0 under the load (K7). False proves nothing.
bool vanish_structurally(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

/// The forces of these contacts are fixed multiples of one number under every load that vanishes where `load` does
/// (K8). False proves nothing.
bool vary_together(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

/// All contacts whose forces are exactly 0, by the pattern alone, for every load that
/// vanishes where `load` does and for all radii (K7; no entry is left out,
/// proofs/definition.md). Ascending; nothing when the pattern has no perfect matching.
std::optional<std::vector<int>> structural_zeros(const Problem& problem, const Forces& load);

} // namespace isostat::checker
