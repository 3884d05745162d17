#pragma once
/// \file
/// First-order change of a vertex when the radii become R_i + eps rho_i (proofs/perturbation.md, P1, P3, P4).

#include "rigidity/contact_pattern.hpp"
#include "verified/configuration.hpp"

#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// Derivatives with respect to eps at eps = 0 of the true vertex with the contacts of `structure`, each enclosed. The
/// contacts stay closed: v = dq/deps solves (G v)_l = -(rho_i + rho_j) (walls: -rho_i; held coordinates: 0).
/// Arithmetic: double, bounds by |H^-1|_2 <= 1 / sigma_min that include the distance from the stored to the true
/// vertex. The arguments must outlive the object. Cost: one solve, and one for each call.
class FirstOrder {
  public:
    /// \pre inverse and enclosure proved; one rho per disk, taken as exact.
    FirstOrder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
               const InverseBound& inverse, const VertexEnclosure& enclosure, const std::vector<double>& rho);

    /// c_m: the gap of a pair that is no contact of the structure is h_m + eps c_m + O(eps^2).
    [[nodiscard]] Enclosure gap(const Contact& contact) const;
    /// Rate of the gap of `contact` when the gap of `opened` grows at unit rate (`direction` -1: falls, for held
    /// coordinates) and the other contacts stay closed. Exactly 0, radius 0, when it vanishes for structural reasons.
    [[nodiscard]] Enclosure rate(ContactId opened, int direction, const Contact& contact) const;
    /// Coefficients a with row of `contact` = sum a_l (row of l), in double: nothing is proved of them.
    [[nodiscard]] std::vector<double> shares(const Contact& contact) const;
    /// Whether the gap of a touching pair stays 0 on the whole motion that opens
    /// `opened`, though grains between its two disks move relative to each other (R2,
    /// degenerate.md). False proves nothing. The first-order gap may still change.
    [[nodiscard]] bool moves_as_linkage(ContactId opened, const Contact& contact) const;
    /// f1 in f = f0 + eps f1 + O(eps^2) at a fixed stress: H f1 = F1 - H1 f0, H1 and F1 the derivatives of the normals
    /// and (true stresses) of the load along v. `f0`, `structural_zero`: one per contact; f1 is {0, 0} where the latter
    /// says that the force vanishes for all positions of the grains. The loaded stress is known to `stress_error`.
    [[nodiscard]] std::vector<Enclosure> forces(const std::vector<Enclosure>& f0,
                                                const std::vector<unsigned char>& structural_zero, const Load& load,
                                                double stress_error = 0) const;

  private:
    struct Velocity {
        std::vector<double> v; ///< on coordinates
        double error = 0;      ///< 2-norm
    };
    [[nodiscard]] Velocity velocity(const std::vector<double>& approach, double approach_error) const;
    [[nodiscard]] Enclosure gap_rate(const Contact& contact, const Velocity& velocity) const;
    /// F1 - H1 f0: the load on first-order forces from turning normals, and from walls whose force depends on a length.
    struct LoadChange {
        std::vector<double> value; ///< on coordinates
        std::vector<double> error; ///< bound, component by component
    };
    void add_stress_change(std::size_t axis, double stress, double stress_error, LoadChange& on) const;
    [[nodiscard]] LoadChange load_change(const std::vector<Enclosure>& f0, const Load& load, double stress_error) const;

    const Packing* packing_;
    const IsostaticStructure* structure_;
    const Factorisation* factorisation_;
    const std::vector<double>* rho_;
    double sigma_ = 0;       ///< lower bound of the smallest singular value at the true vertex
    double uncertainty_ = 0; ///< |H - H*|_2, H that of the structure
    double away_ = 0;        ///< |q - q*|_2
    Velocity change_;        ///< v
};

} // namespace isostat
