#pragma once
// Whether the grains of a cell that carry a force are jammed, by linear programmes in double, against what `inspect`
// says of the state and what the exact packing says.

#include "contradictions/exact.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

namespace contradictions {

using isostat::Verdict;

namespace detail {

/// Velocities of the grains that carry a force, the first one at rest, and of the lengths and tilts of the cell.
class Motions {
  public:
    Motions(const State& state, const Truth& truth) : truth_(truth), axes_(state.packing.dimension) {
        const auto& contacts = state.contacts;
        std::vector<bool> carries(state.packing.radius.size(), false);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (sign_of(truth.force[l], truth.force_scale) != 0) {
                carries[static_cast<std::size_t>(contacts[l].i)] = carries[static_cast<std::size_t>(contacts[l].j)] =
                    true;
            }
        }
        for (std::size_t i = 0; i < carries.size(); ++i) {
            if (carries[i]) {
                column_[static_cast<int>(i)] = axes_ * (static_cast<int>(column_.size()) - 1);
            }
        }
        cell_ = axes_ * (static_cast<int>(column_.size()) - 1);
        const auto touches = [&](const Contact& c) {
            if (c.kind == ContactKind::disk_disk && column_.contains(c.i) && column_.contains(c.j)) {
                touching_.push_back(c);
            }
        };
        std::ranges::for_each(contacts, touches);
        for (const OtherPair& other : truth.others) {
            if (sign_of(other.gap, Real(state.packing.min_radius())) == 0) {
                touches(other.pair);
            }
        }
        for (int a = 0; a < axes_; ++a) {
            length_.push_back(static_cast<double>(truth.q[state.packing.length_at(a)]));
        }
    }
    [[nodiscard]] int disks() const { return static_cast<int>(column_.size()); }

    /// No motion but translations keeps all gaps >= 0; `strains`: of disks and cell, while the volume does not grow.
    [[nodiscard]] Verdict jammed(bool strains) const {
        const Eigen::MatrixXd rows = rates(strains);
        if (rows.cols() == 0) {
            return Verdict::proved;
        }
        if (strains && rows.rows() == rows.cols() + 1) { // isostatic: the forces under an isotropic pressure decide
            const Eigen::VectorXd pressure = -rows.bottomRows(1).transpose();
            const Eigen::VectorXd force = rows.topRows(rows.cols()).transpose().fullPivLu().solve(pressure);
            if (force.cwiseAbs().minCoeff() < 1e-6 * force.cwiseAbs().maxCoeff()) {
                return Verdict::undecided; // too small for doubles
            }
        }
        const auto [most, error] = largest_sum(rows);
        if (most - 2 * error > 1e-6) {
            return Verdict::refuted;
        }
        const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues();
        const double least = rows.rows() < rows.cols() ? 0 : sizes.minCoeff() / sizes.maxCoeff();
        return least < 1e-12                         ? Verdict::refuted
               : least > 1e-8 && most + error < 1e-8 ? Verdict::proved
                                                     : Verdict::undecided;
    }

  private:
    /// Per touching pair how fast its gap grows; with strains also how fast the volume shrinks, relatively.
    [[nodiscard]] Eigen::MatrixXd rates(bool strains) const {
        const auto pairs = static_cast<Eigen::Index>(touching_.size());
        const int tilts = axes_ * (axes_ - 1) / 2;
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(pairs + (strains ? 1 : 0), cell_ + (strains ? axes_ + tilts : 0));
        for (Eigen::Index l = 0; l < pairs; ++l) {
            const Contact& c = touching_[static_cast<std::size_t>(l)];
            const auto r = truth_.between(c);
            Eigen::RowVectorXd n(axes_);
            for (int a = 0; a < axes_; ++a) {
                n(a) = static_cast<double>(r[static_cast<std::size_t>(a)]);
            }
            n.normalize();
            for (const auto& [disk, sign] : {std::pair(c.j, 1), std::pair(c.i, -1)}) {
                if (const int column = column_.at(disk); column >= 0) {
                    rows.block(l, column, 1, axes_) += sign * n;
                }
            }
            for (int b = 0; strains && b < axes_; ++b) {
                const int m = c.image.m[static_cast<std::size_t>(b)];
                rows(l, cell_ + b) = n(b) * m;
                for (int a = 0; a < b; ++a) {
                    rows(l, cell_ + axes_ + a + b * (b - 1) / 2) = n(a) * m;
                }
            }
        }
        for (int a = 0; strains && a < axes_; ++a) {
            rows(pairs, cell_ + a) = -1 / length_[static_cast<std::size_t>(a)];
        }
        return rows;
    }

    struct Sum {
        double value, error;
    };
    /// The largest sum of all rates when none is negative and no coordinate is faster than 1. Rates may be below 0 by
    /// the tolerance of the programme, which its prices make into an error of the sum.
    static Sum largest_sum(const Eigen::MatrixXd& rows) {
        constexpr double tolerance = 1e-10;
        const auto m = static_cast<int>(rows.rows());
        const auto n = static_cast<int>(rows.cols());
        CoinPackedMatrix matrix(false, 0.0, 0.0);
        matrix.setDimensions(0, n);
        for (int l = 0; l < m; ++l) {
            std::vector<int> index;
            std::vector<double> value;
            for (int k = 0; k < n; ++k) {
                if (rows(l, k) != 0) {
                    index.push_back(k);
                    value.push_back(rows(l, k));
                }
            }
            matrix.appendRow(static_cast<int>(index.size()), index.data(), value.data());
        }
        const Eigen::VectorXd sum = rows.colwise().sum().transpose();
        const std::vector<double> slow(static_cast<std::size_t>(n), -1.0), fast(static_cast<std::size_t>(n), 1.0);
        const std::vector<double> none(static_cast<std::size_t>(m), 0.0);
        ClpSimplex programme;
        programme.setLogLevel(0);
        programme.setPrimalTolerance(tolerance);
        programme.loadProblem(matrix, slow.data(), fast.data(), sum.data(), none.data(), nullptr);
        programme.setOptimizationDirection(-1);
        programme.primal();
        double prices = 0;
        for (int l = 0; l < m; ++l) {
            prices += std::abs(programme.dualRowSolution()[l]);
        }
        const double infinite = std::numeric_limits<double>::infinity();
        return programme.isProvenOptimal() ? Sum{programme.objectiveValue(), tolerance * prices} : Sum{0, infinite};
    }

    const Truth& truth_;
    int axes_;
    std::map<int, int> column_; ///< of grains that carry a force; that of the first one is below 0
    int cell_ = 0;              ///< first column of the cell
    std::vector<Contact> touching_;
    std::vector<double> length_;
};

} // namespace detail

/// Programmes in double tell nothing then.
inline bool nearly_singular(const Truth& truth) {
    constexpr double little = 1e-6;
    bool weak = truth.singular_value() < little;
    for (const Real& force : truth.force) {
        weak = weak || (sign_of(force, truth.force_scale) != 0 && abs(force) < little * truth.force_scale);
    }
    return weak;
}

/// Two answers of which one is proved and the other refuted, in words.
inline std::vector<std::string> jamming_objections(const State& state, const Truth& truth,
                                                   const isostat::Certification& certified) {
    if (!state.packing.cell.all() || truth.equilibrium() <= 0 || nearly_singular(truth)) {
        return {};
    }
    const detail::Motions motions(state, truth);
    const isostat::CellInspection seen = isostat::inspect_cell(state, certified);
    std::optional<isostat::crafted::Jamming> exact;
    if (truth.stored_gap == 0) { // the doubles touch
        const auto inspected = isostat::crafted::inspect(isostat::crafted::exact_copy(state.packing));
        exact = inspected.ok() ? inspected.value().jamming : std::nullopt;
    }
    std::vector<std::string> wrong;
    for (const bool strict : {false, true}) {
        std::map<std::string, Verdict> answers{{"a linear programme", motions.jammed(strict)},
                                               {"inspect", (strict ? seen.strict : seen.collective).verdict}};
        if (exact && exact->disks == motions.disks()) {
            answers["the exact packing"] = strict ? exact->strict.value() : exact->collective;
        }
        for (const auto& [one, yes] : answers) {
            for (const auto& [other, no] : answers) {
                if (yes == Verdict::proved && no == Verdict::refuted) {
                    wrong.push_back((strict ? "jammed strictly: " : "jammed collectively: ") + one + " proves it, " +
                                    other + " refutes it");
                }
            }
        }
    }
    return wrong;
}

} // namespace contradictions
