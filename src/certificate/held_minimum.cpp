#include "certificate/held_minimum.hpp"

#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "packing/arc_bodies.hpp"
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
        motion.v[static_cast<std::size_t>(vertex.structure.dofs().coordinate_of(static_cast<int>(mu)))] = -on_dofs[mu];
        square += on_dofs[mu] * on_dofs[mu];
    }
    motion.size = std::sqrt(square) * up;
    double residual = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const GapGradient g = gap_gradient(vertex.packing, contacts[l]);
        double rate = l == slot ? -1.0 : 0.0;
        double terms = std::abs(rate);
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

HeldMotion least_curved(const Vertex& vertex, const std::vector<double>& forces,
                        const std::vector<std::size_t>& slots) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<HeldMotion> motions;
    for (const std::size_t slot : slots) {
        motions.push_back(motion_of(vertex, slot));
    }
    const auto k = static_cast<Eigen::Index>(motions.size());
    Eigen::MatrixXd form = Eigen::MatrixXd::Zero(k, k);
    Eigen::MatrixXd at(k, static_cast<Eigen::Index>(most_axes)); // relative velocities in one contact
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].of_disks()) {
            for (Eigen::Index i = 0; i < k; ++i) {
                const auto u_l =
                    separation(vertex.packing.layout(), motions[static_cast<std::size_t>(i)].v, contacts[l]);
                at.row(i) = Eigen::Map<const Eigen::RowVectorXd>(u_l.data(), at.cols());
            }
            form -= forces[l] / zero_distance(vertex.packing, contacts[l]) * at * at.transpose();
        }
    }
    const Eigen::VectorXd least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(form).eigenvectors().col(0);
    HeldMotion sum{std::vector<double>(vertex.packing.q.size(), 0.0)};
    for (Eigen::Index i = 0; i < k; ++i) {
        const HeldMotion& m = motions[static_cast<std::size_t>(i)];
        const double share = least(i) / std::abs(least.cwiseAbs().maxCoeff());
        for (std::size_t c = 0; c < sum.v.size(); ++c) {
            sum.v[c] += share * m.v[c];
        }
        sum.size += std::abs(share) * m.size * up;
        sum.residual += std::abs(share) * (m.residual + 16 * static_cast<double>(k) * u * m.size) * up;
    }
    return sum;
}

namespace {

/// The proof for held coordinates that move by a `reach`, on which the configuration moves by at most `way` (2-norms).
class HeldForm {
  public:
    HeldForm(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting)
        : vertex_(vertex), contacts_(vertex.structure.contacts()), sigma_(sigma), acting_(acting),
          lipschitz_(lipschitz(vertex.packing, contacts_)), arcs_(vertex.packing) {
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
        if (!(sigma_min_ > 0) || !(arcs_.below(nearest) > 2 * way) || !stay_in_sectors(way)) {
            return {};
        }
        turned_ = turned;
        reach_ = way / fastest();
        force_changes_ = lipschitz_ * way / sigma_min_ * force_size_ * up;
        if (!forces_stay_positive()) {
            return {};
        }
        const double curvature = least_curvature();
        const double multiplier = multiplier_size();
        if (!(curvature > 0) || !(multiplier < 0.49 * curvature * reach_)) {
            return {};
        }
        HeldMinimum minimum{(vertex_.enclosure.distance() + multiplier / curvature * fastest()) * up, curvature};
        find_rates(minimum);
        return minimum;
    }

  private:
    [[nodiscard]] bool stay_in_sectors(double way) const {
        const double distance = vertex_.enclosure.distance();
        const double moved = (way + distance) * up;
        return !arcs_.any() || (distance < way / 16 && moved < arcs_.farthest() &&
                                std::all_of(contacts_.begin(), contacts_.end(),
                                            [&](const Contact& contact) { return arcs_.faces(contact, moved); }));
    }
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

    /// The most that the configuration moves (2-norm) where the held coordinates move by 1, anywhere within reach.
    [[nodiscard]] double fastest() const {
        double square = 0;
        for (const HeldMotion& m : motions_) {
            const double most = m.size + (m.residual + turned_ * m.size) / sigma_min_ * up;
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

    /// The form and what it may be off by, anywhere within reach.
    [[nodiscard]] std::pair<Eigen::MatrixXd, Eigen::MatrixXd> second_variation() const {
        const auto k = static_cast<Eigen::Index>(motions_.size());
        Eigen::MatrixXd form = Eigen::MatrixXd::Zero(k, k);
        Eigen::MatrixXd error = form;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (contacts_[l].of_disks()) {
                add(l, form, error);
            }
        }
        return {form, error};
    }

    /// dc = - M^-1 dmu: what that leaves over the smallest eigenvalue (U10). At the minimum, which is within reach.
    void find_rates(HeldMinimum& minimum) const {
        const auto [form, error] = second_variation();
        double slopes = 0;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            const Enclosure f = vertex_.statics.slope(ContactId(l));
            slopes += (std::abs(f.value) + f.radius) * (std::abs(f.value) + f.radius);
        }
        const double changes = force_changes_ / force_size_ * std::sqrt(slopes) * up;
        Eigen::VectorXd multiplier(form.rows());
        Eigen::VectorXd open(form.rows());
        for (std::size_t i = 0; i < acting_.size(); ++i) {
            const Enclosure slope = vertex_.statics.slope(ContactId(acting_[i]));
            multiplier(static_cast<Eigen::Index>(i)) = slope.value;
            open(static_cast<Eigen::Index>(i)) = slope.radius + changes;
        }
        const Eigen::VectorXd rate = -form.ldlt().solve(multiplier);
        const double roundings = static_cast<double>(form.rows() + 4) * u;
        const Eigen::VectorXd size = form.cwiseAbs() * rate.cwiseAbs() + multiplier.cwiseAbs();
        const Eigen::VectorXd rest =
            (form * rate + multiplier).cwiseAbs() + error * rate.cwiseAbs() + open + roundings * size;
        minimum.rate.assign(rate.begin(), rate.end());
        minimum.rate_bound = rest.norm() / minimum.curvature * up;
        for (std::size_t a = 0; a < vertex_.packing.axes(); ++a) {
            double value = 0;
            double bound = 0;
            for (std::size_t i = 0; i < motions_.size(); ++i) {
                const double v = motions_[i].v[vertex_.packing.length_at(a)];
                const double c = minimum.rate[i];
                const double off = (motions_[i].residual + turned_ * motions_[i].size) / sigma_min_ * up;
                value += v * c;
                bound += (std::abs(v) + off) * minimum.rate_bound + (off + roundings * std::abs(v)) * std::abs(c);
            }
            minimum.length_rate[a] = {value, bound * up};
        }
    }

    /// A number that no eigenvalue of the form is below, anywhere within reach: eigenvectors as they are computed, and
    /// Gershgorin's discs of what they leave.
    [[nodiscard]] double least_curvature() const {
        const auto [form, error] = second_variation();
        const auto k = form.rows();
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
    ArcBodies arcs_;
    double force_size_ = 0;
    std::vector<HeldMotion> motions_;
    double reach_ = 0, turned_ = 0, sigma_min_ = 0, force_changes_ = 0;
};

/// Where something that changes at a `rate`, a sum of `terms` in magnitude, is 0: counted in the direction of the
/// stress.
double way_to_zero(double value, double rate, double terms, int direction) {
    const double falls = -direction * rate;
    return falls > 0x1p-40 * terms ? value / falls : std::numeric_limits<double>::infinity();
}

} // namespace

Yielding yielding_at(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting,
                     const HeldMinimum& minimum, const std::vector<Contact>& candidates) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<double> velocity(vertex.packing.q.size(), 0.0);
    for (std::size_t i = 0; i < acting.size(); ++i) {
        const HeldMotion motion = motion_of(vertex, acting[i]);
        for (std::size_t k = 0; k < velocity.size(); ++k) {
            velocity[k] += minimum.rate[i] * motion.v[k];
        }
    }
    // H f' + H' f = F': normals turn with the relative velocity over the distance.
    std::vector<double> turning(contacts.size(), 0.0); // on degrees of freedom
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (!contacts[l].of_disks()) {
            continue;
        }
        const auto along = separation(vertex.packing.layout(), velocity, contacts[l]);
        const double times =
            vertex.statics.force(ContactId(l), sigma).value / zero_distance(vertex.packing, contacts[l]);
        Separation(contacts[l], vertex.packing.layout())
            .for_each_entry(vertex.structure.dofs(), along,
                            [&](int dof, double entry) { turning[static_cast<std::size_t>(dof)] -= times * entry; });
    }
    vertex.factorisation.solve_forces(turning);
    Yielding yielding;
    yielding.length_rate = minimum.length_rate;
    for (const int direction : {-1, 1}) {
        Yielding::Event& event = direction < 0 ? yielding.down : yielding.up;
        double nearest = std::numeric_limits<double>::infinity();
        const auto look = [&](const Contact& contact, bool opens, double value, double rate, double terms) {
            if (const double way = way_to_zero(value, rate, terms, direction); way < nearest) {
                nearest = way;
                event = {contact, opens, sigma + direction * way};
            }
        };
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].is_unilateral() && !vertex.statics.is_structural_zero(ContactId(l))) {
                const double slope = vertex.statics.slope(ContactId(l)).value;
                look(contacts[l], true, vertex.statics.force(ContactId(l), sigma).value, slope + turning[l],
                     std::abs(slope) + std::abs(turning[l]));
            }
        }
        for (const Contact& pair : candidates) {
            const GapGradient g = gap_gradient(vertex.packing, pair);
            double rate = 0;
            double terms = 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(g.count); ++k) {
                const double term = g.value[k] * velocity[static_cast<std::size_t>(g.coordinate[k])];
                rate += term;
                terms += std::abs(term);
            }
            look(pair, false, gap(vertex.packing, pair), rate, terms);
        }
    }
    return yielding;
}

std::optional<HeldMinimum> minimum_near(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting,
                                        double nearest) {
    HeldForm form(vertex, sigma, acting);
    std::optional<HeldMinimum> best;
    for (double share = 0x1p-3; share > 0x1p-40; share *= 0x1p-3) { // on a shorter way the form changes less
        if (auto minimum = form.prove(share * vertex.packing.min_radius(), nearest)) {
            best = std::move(minimum);
        } else if (best) {
            break;
        }
    }
    return best;
}

} // namespace isostat
