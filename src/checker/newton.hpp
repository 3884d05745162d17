#pragma once
/// \file
/// Newton's iteration in double on the polynomial system of a contact list,
/// with one factorisation for many steps. Its results are not trusted.

#include "checker/solver.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace isostat::checker {

/// F(q) = 0 for the contacts of a list, in the units of proofs/checker.md. `packing` must outlive it.
class System {
  public:
    /// `near`: factors of the same list at a nearby configuration, or
    /// null. They are made anew when iterations do not converge with them. `like`: of nearly the same list, or null.
    System(const Packing& packing, std::vector<Contact> contacts, std::shared_ptr<const Solver> near = {},
           std::shared_ptr<const Solver> like = {});

    [[nodiscard]] bool square() const { return contacts_.size() == structure_.coordinate_of.size(); }
    [[nodiscard]] std::size_t size() const { return structure_.coordinate_of.size(); }
    [[nodiscard]] std::size_t coordinate(std::size_t dof) const {
        return static_cast<std::size_t>(structure_.coordinate_of[dof]);
    }
    /// Holds one coordinate at a given value; the other held coordinates keep their values in the packing.
    void hold(const Contact& c, double at) { fresh_ = {c, at}; }
    [[nodiscard]] double held_value(const Contact& c) const;
    template <class T> [[nodiscard]] T value(const std::vector<T>& q, const Contact& c) const {
        return value(q, c, Row(c, packing_.layout()));
    }
    [[nodiscard]] std::shared_ptr<const Solver> solver() const { return solver_; }

    /// A(q) v = e_opened, its residual rounded to so many bits; on entry v is a guess, or empty.
    // choice: rounding of the velocity of a step
    bool motion(const std::vector<double>& q, std::size_t opened, Eigen::VectorXd& v, int bits = 46);
    /// Newton to a zero of all F except that of contact `left_out`, with a degree of freedom kept in place; the
    /// iteration ends at steps of the largest radius times `accuracy`, or where rounding lets them fall no more. The
    /// last step, in largest radii; nothing: it does not converge.
    struct Way {
        std::size_t left_out;
        Eigen::Index kept;
    };
    std::optional<double> newton(std::vector<double>& q, const std::optional<Way>& way, double accuracy);
    /// The second derivative, halved, of the curve through q with derivative v along which all F but that of `left_out`
    /// stay 0 and the coordinate moves at a constant rate, with the present factors.
    [[nodiscard]] Eigen::VectorXd bend(const Eigen::VectorXd& v, const Way& way);
    /// Largest component of A^-1 for a residual of a squared largest radius in every F, of mixed signs, in largest
    /// radii: about how much Newton's method in double enlarges roundings. A solve.
    [[nodiscard]] double spread() const;
    /// Newton to a zero of all F where the contacts may be nearly
    /// singular: F in quadruple precision, new factors where the last ones do not serve.
    bool newton_in_quadruple(std::vector<double>& q, const std::optional<Way>& way = {});

  private:
    void renew(const std::vector<double>& q);
    template <class T> [[nodiscard]] T value(const std::vector<T>& q, const Contact& c, const Row& row) const;
    [[nodiscard]] Eigen::VectorXd step(const Eigen::VectorXd& residual) const;
    template <class T> [[nodiscard]] Eigen::VectorXd step_at(const std::vector<T>& q, const std::optional<Way>& way);
    [[nodiscard]] Eigen::VectorXd step_along(Eigen::VectorXd residual, const Way& way);
    const Eigen::VectorXd& kernel(std::size_t left_out);
    [[nodiscard]] Eigen::VectorXd product(const std::vector<double>& q, const Eigen::VectorXd& v) const;

    const Packing& packing_;
    std::vector<Contact> contacts_;
    Structure structure_;
    double weight_; ///< scale of the rows of walls
    std::shared_ptr<const Solver> solver_;
    std::shared_ptr<const Solver> like_;
    std::optional<std::pair<std::size_t, Eigen::VectorXd>> kernel_; ///< the step for e_l, with the present factors
    std::optional<std::pair<Contact, double>> fresh_;
};

} // namespace isostat::checker
