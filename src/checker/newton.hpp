#pragma once
/// \file
/// Newton's iteration in double on the polynomial system of a contact list, with one factorisation for many steps.
/// Nothing that comes out of here is trusted.

#include "checker/solver.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace isostat::checker {

/// F(q) = 0 for the contacts of a list, in the units of proofs/checker.md. `packing` must outlive it.
class System {
  public:
    /// `near`: factors of the same list at a configuration close by, or nothing. They serve as long as the iterations
    /// converge with them, then they are made anew.
    System(const Packing& packing, std::vector<Contact> contacts, std::shared_ptr<const Solver> near = {});

    [[nodiscard]] bool square() const { return contacts_.size() == structure_.coordinate_of.size(); }
    [[nodiscard]] std::size_t size() const { return structure_.coordinate_of.size(); }
    [[nodiscard]] std::size_t coordinate(std::size_t dof) const {
        return static_cast<std::size_t>(structure_.coordinate_of[dof]);
    }
    /// A coordinate that becomes held at a value of its own; the others are held where the packing has them.
    void hold(const Contact& c, double at) { fresh_ = {c, at}; }
    [[nodiscard]] double held_value(const Contact& c) const;
    template <class T> [[nodiscard]] T value(const std::vector<T>& q, const Contact& c) const;
    [[nodiscard]] std::shared_ptr<const Solver> solver() const { return solver_; }

    /// A(q) v = e_opened; v before is a guess, or empty.
    bool motion(const std::vector<double>& q, std::size_t opened, Eigen::VectorXd& v);
    /// To a zero of all F but that of contact `left_out`, a degree of freedom being kept in its place; steps of the
    /// largest radius times `accuracy` end the iteration.
    struct Way {
        std::size_t left_out;
        Eigen::Index kept;
    };
    bool newton(std::vector<double>& q, const std::optional<Way>& way, double accuracy);
    /// To a zero of all F where the contacts are nearly singular: F in quadruple precision, factors made anew at each
    /// step.
    bool newton_in_quadruple(std::vector<double>& q, const std::optional<Way>& way = {});
    /// The next step with F in quadruple precision, in units of the largest radius: F in double may be too rough.
    [[nodiscard]] double step_in_quadruple(const std::vector<double>& q);

  private:
    void renew(const std::vector<double>& q);
    [[nodiscard]] Eigen::VectorXd step(const Eigen::VectorXd& residual) const;
    template <class T> [[nodiscard]] Eigen::VectorXd step_at(const std::vector<T>& q, const std::optional<Way>& way);
    [[nodiscard]] Eigen::VectorXd product(const std::vector<double>& q, const Eigen::VectorXd& v) const;

    const Packing& packing_;
    std::vector<Contact> contacts_;
    Structure structure_;
    double weight_; ///< of walls
    std::shared_ptr<const Solver> solver_;
    std::optional<std::pair<std::size_t, Eigen::VectorXd>> kernel_; ///< the step for e_l, with the present factors
    std::optional<std::pair<Contact, double>> fresh_;
};

} // namespace isostat::checker
