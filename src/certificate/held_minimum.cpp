#include "certificate/held_minimum.hpp"

#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "verified/vertex_bounds.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace isostat {

namespace {

using roundoff::u;

constexpr double up = 1 + 1e-9; // sums and products of fewer than 10^6 bounds, three deep

} // namespace

HeldMotion motion_of(const Vertex& vertex, std::size_t slot) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<double> on_dofs(contacts.size(), 0.0);
    on_dofs[slot] = 1;
    vertex.factorisation.solve_velocities(on_dofs);
    HeldMotion motion{std::vector<double>(vertex.packing.q.size(), 0.0)};
    double square = 0;
    for (std::size_t mu = 0; mu < on_dofs.size(); ++mu) {
        motion.v[static_cast<std::size_t>(vertex.structure.dofs().coordinate_of(static_cast<int>(mu)))] = on_dofs[mu];
        square += on_dofs[mu] * on_dofs[mu];
    }
    motion.size = std::sqrt(square) * up;
    double residual = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const GapGradient g = gap_gradient(vertex.packing, contacts[l]);
        double rate = l == slot ? 1.0 : 0.0;
        double terms = rate;
        for (int k = 0; k < g.count; ++k) {
            const auto e = static_cast<std::size_t>(k);
            const double term = g.value[e] * motion.v[static_cast<std::size_t>(g.coordinate[e])];
            rate += term;
            terms += std::abs(term);
        }
        const double bound = std::abs(rate) + 16 * u * terms;
        residual += bound * bound;
    }
    motion.residual = std::sqrt(residual) * up;
    return motion;
}

namespace {

/// The proof for held coordinates that move by a `reach`, on which the configuration moves by at most `way` (2-norms).
class HeldForm {
  public:
    HeldForm(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting)
        : vertex_(vertex), contacts_(vertex.structure.contacts()), sigma_(sigma), acting_(acting),
          lipschitz_(lipschitz(vertex.packing, contacts_)) {
        double square = 0;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            const Enclosure f = force(l);
            square += (std::abs(f.value) + f.radius) * (std::abs(f.value) + f.radius);
        }
        force_size_ = std::sqrt(square) * up;
        for (const std::size_t slot : acting_) {
            motions_.push_back(motion_of(vertex, slot));
        }
    }

    std::optional<HeldMinimum> prove(double way, double nearest) {
        const double turned = (vertex_.statics.normal_uncertainty() + lipschitz_ * way) * up;
        sigma_min_ = (vertex_.inverse.sigma_min - turned) / up;
        if (!(sigma_min_ > 0) || !(nearest > 2 * way)) {
            return {};
        }
        reach_ = way * sigma_min_ / up;
        turned_ = turned;
        force_changes_ = lipschitz_ * way / sigma_min_ * force_size_ * up;
        if (!forces_stay_positive()) {
            return {};
        }
        const double curvature = least_curvature();
        const double multiplier = multiplier_size();
        if (!(curvature > 0) || !(multiplier < 0.49 * curvature * reach_)) {
            return {};
        }
        return HeldMinimum{(vertex_.enclosure.distance() + multiplier / curvature / sigma_min_) * up, curvature};
    }

  private:
    [[nodiscard]] Enclosure force(std::size_t l) const { return vertex_.statics.force(ContactId(l), sigma_); }

    [[nodiscard]] bool forces_stay_positive() const {
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            const Enclosure f = force(l);
            if (contacts_[l].is_unilateral() && !(f.value > (f.radius + force_changes_) * up)) {
                return false;
            }
        }
        return true;
    }

    /// Of all held coordinates that are no free motions.
    [[nodiscard]] double multiplier_size() const {
        double square = 0;
        for (const std::size_t slot : acting_) {
            const double most = std::abs(force(slot).value) + force(slot).radius;
            square += most * most;
        }
        return std::sqrt(square) * up;
    }

    /// |D_l (v - v~)| of a motion, anywhere within reach.
    [[nodiscard]] double relative_error(const HeldMotion& m) const {
        return std::sqrt(2.0) * (m.residual + turned_ * m.size) / sigma_min_ * up;
    }

    /// d2W = - sum f_l D_l v_i . D_l v_j / D_l, as the kept gaps do not change: and by how much it may be off.
    void add(std::size_t l, Eigen::MatrixXd& form, Eigen::MatrixXd& error) const {
        const double d = zero_distance(vertex_.packing, contacts_[l]);
        const double f = force(l).value;
        const double f_error = (force(l).radius + force_changes_) * up;
        const double roundings = (static_cast<double>(contacts_.size()) + 32) * u;
        std::vector<PerAxis<double>> at;
        std::vector<double> size;
        for (const HeldMotion& m : motions_) {
            at.push_back(separation(vertex_.packing.layout(), m.v, contacts_[l]));
            double square = 0;
            for (const double x : at.back()) {
                square += x * x;
            }
            size.push_back(std::sqrt(square) * up);
        }
        for (std::size_t i = 0; i < motions_.size(); ++i) {
            for (std::size_t j = 0; j < motions_.size(); ++j) {
                double product = 0;
                for (std::size_t a = 0; a < vertex_.packing.axes(); ++a) {
                    product += at[i][a] * at[j][a];
                }
                const auto row = static_cast<Eigen::Index>(i);
                const auto column = static_cast<Eigen::Index>(j);
                const double moved = (size[i] + relative_error(motions_[i])) * (size[j] + relative_error(motions_[j]));
                const double open = moved - size[i] * size[j] / (up * up * up * up);
                form(row, column) -= f * product / d;
                error(row, column) += (std::abs(f) * (open + roundings * moved) + f_error * moved) / d * up;
            }
        }
    }

    /// A number that no eigenvalue of the form is below, anywhere within reach: eigenvectors as they are computed, and
    /// Gershgorin's discs of what they leave.
    [[nodiscard]] double least_curvature() const {
        const auto k = static_cast<Eigen::Index>(motions_.size());
        Eigen::MatrixXd form = Eigen::MatrixXd::Zero(k, k);
        Eigen::MatrixXd error = form;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (contacts_[l].of_disks()) {
                add(l, form, error);
            }
        }
        const Eigen::MatrixXd q = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(form).eigenvectors();
        const Eigen::MatrixXd rotated = q.transpose() * form * q;
        const double roundings = 4 * static_cast<double>(k + 2) * u;
        const Eigen::MatrixXd size = q.cwiseAbs();
        const Eigen::MatrixXd off = size.transpose() * (error + roundings * form.cwiseAbs()) * size * up;
        const Eigen::MatrixXd square = (q.transpose() * q).cwiseAbs();
        double least = std::numeric_limits<double>::infinity();
        double stretch = 0;
        for (Eigen::Index i = 0; i < k; ++i) {
            const double others = rotated.row(i).cwiseAbs().sum() - std::abs(rotated(i, i));
            const double disc = rotated(i, i) - (others + off.row(i).sum()) * up;
            if (!std::isfinite(disc)) { // loads or lengths beyond the range of double
                return 0;
            }
            least = std::min(least, disc);
            stretch = std::max(stretch, square.row(i).sum() + roundings * static_cast<double>(k));
        }
        return least / (stretch * up);
    }

    const Vertex& vertex_;
    const std::vector<Contact>& contacts_;
    double sigma_;
    const std::vector<std::size_t>& acting_;
    double lipschitz_;
    double force_size_ = 0;
    std::vector<HeldMotion> motions_;
    double reach_ = 0, turned_ = 0, sigma_min_ = 0, force_changes_ = 0;
};

} // namespace

std::optional<HeldMinimum> minimum_near(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting,
                                        double nearest) {
    HeldForm form(vertex, sigma, acting);
    std::optional<HeldMinimum> best;
    for (double share = 0x1p-3; share > 0x1p-40; share *= 0x1p-3) { // on a shorter way the form changes less
        const auto minimum = form.prove(share * vertex.packing.min_radius(), nearest);
        if (best && (!minimum || minimum->curvature < 1.01 * best->curvature)) {
            break;
        }
        best = minimum;
    }
    return best;
}

} // namespace isostat
