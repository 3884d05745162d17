#include "crafted/enclosed_bases.hpp"

#include "contact/separation.hpp"
#include "contact/words.hpp"
#include "core/roundoff.hpp"
#include "io/json.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/force_solution.hpp"
#include "verified/proved_structure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace isostat::crafted {

namespace {

using roundoff::u;
/// Factor that covers the rounding of the bounds themselves.
constexpr double upwards = 1 + 1e-9;

double norm(const std::vector<double>& x) {
    double sum = 0;
    for (const double y : x) {
        sum += y * y;
    }
    return std::sqrt(sum) * upwards;
}

class Encloser {
  public:
    Encloser(const ExactPacking& packing, const Inspection& inspection) : inspection_(inspection) {
        stored_ = approximate(packing);
        // Conversion to doubles moves each coordinate by at most half a grid step.
        const double moved = grid_step(stored_);
        for (const Contact& contact : inspection.contacts) {
            double distance = std::numeric_limits<double>::infinity();
            if (contact.of_disks()) {
                distance = touching_distance(stored_.radius, contact);
            }
            double steps = 0, square = 0;
            Separation(contact, stored_.layout()).for_each_coordinate([&](std::size_t, std::size_t, int multiple) {
                steps += std::abs(multiple);
                square += multiple * multiple;
            });
            // |a / |a| - b / |b|| <= 2 |a - b| / |a|, times the multiples in the column.
            column_error_.push_back(2 * std::sqrt(square) * steps * moved / distance * upwards);
        }
    }

    EnclosedBases run(const exact::RankBound& independent, int count) {
        EnclosedBases out;
        std::vector<Contact> kept;
        double change = 0;
        std::vector<unsigned char> chosen(inspection_.contacts.size(), 0);
        for (const int l : independent.columns) {
            chosen[static_cast<std::size_t>(l)] = 1;
            kept.push_back(inspection_.contacts[static_cast<std::size_t>(l)]);
            change += column_error_[static_cast<std::size_t>(l)] * column_error_[static_cast<std::size_t>(l)];
        }
        change_ = std::sqrt(change) * upwards;
        for (std::size_t l = 0; l < chosen.size(); ++l) {
            if (chosen[l] == 0) {
                out.free_contacts.push_back(static_cast<int>(l));
            }
        }
        const DofMap dofs(stored_);
        out.free_dofs = independent.free_rows;
        for (const int dof : out.free_dofs) {
            kept.push_back({ContactKind::held, dofs.coordinate_of(dof), 0});
        }
        const auto made = ProvedStructure::make(stored_, kept);
        if (!made.ok() || made.value()->inverse.verdict != Verdict::proved ||
            !(made.value()->inverse.sigma_min > 2 * change_)) {
            return out;
        }
        const ProvedStructure& at = *made.value();
        sigma_ = (at.inverse.sigma_min - change_) / upwards; // of the exact matrix
        out.verdict = Verdict::proved;
        for (int k = 0; k < count && k < static_cast<int>(out.free_contacts.size()); ++k) {
            out.self_stresses.push_back(
                self_stress(at, independent.columns, out.free_contacts[static_cast<std::size_t>(k)]));
        }
        for (int k = 0; k < count && k < static_cast<int>(out.free_dofs.size()); ++k) {
            out.motions.push_back(motion(at, independent.columns.size() + static_cast<std::size_t>(k),
                                         out.free_dofs[static_cast<std::size_t>(k)]));
        }
        for (const auto* vectors : {&out.self_stresses, &out.motions}) {
            for (const EnclosedVector& vector : *vectors) {
                if (!std::isfinite(vector.radius)) {
                    out = {};
                    return out;
                }
            }
        }
        return out;
    }

  private:
    /// Forces of the independent contacts that balance a unit force in the free contact; the multipliers of the held
    /// degrees of freedom are 0 because the column of the free contact depends on the others (the rank is proved).
    [[nodiscard]] EnclosedVector self_stress(const ProvedStructure& at, const std::vector<int>& columns,
                                             int free) const {
        const IsostaticStructure& structure = at.structure;
        const auto l = static_cast<std::size_t>(free);
        std::vector<double> right(static_cast<std::size_t>(structure.size()), 0.0);
        gap_gradient(stored_, inspection_.contacts[l])
            .for_each_dof(structure.dofs(), [&](std::size_t dof, double value) {
                right[dof] = value; // minus the column of the free contact
            });
        const ForceSolution solution = solve_forces(structure, at.factorisation, at.inverse, right);
        EnclosedVector out;
        out.free = free;
        out.value.assign(inspection_.contacts.size(), 0.0);
        out.value[l] = 1;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            out.value[static_cast<std::size_t>(columns[k])] = solution.value[k];
        }
        const double size = norm(solution.value) + solution.bound * std::sqrt(static_cast<double>(structure.size()));
        const double right_error = column_error_[l] + 16 * u; // errors of the normal, and of its rounding
        out.radius = (solution.bound + (right_error + change_ * size) / sigma_) * upwards;
        return out;
    }

    /// Velocity that keeps all gaps constant and is 1 in the held degree of freedom number `row` of the structure.
    [[nodiscard]] EnclosedVector motion(const ProvedStructure& at, std::size_t row, int free) const {
        std::vector<double> v(static_cast<std::size_t>(at.structure.size()), 0.0);
        v[row] = -1; // approach velocities: the column of a held coordinate is -1
        at.factorisation.solve_velocities(v);
        const auto& matrix = at.structure.matrix();
        double residual = 0;
        for (std::size_t c = 0; c + 1 < matrix.start.size(); ++c) {
            double sum = c == row ? 1 : 0;
            double size = std::abs(sum);
            for (auto e = static_cast<std::size_t>(matrix.start[c]); e < static_cast<std::size_t>(matrix.start[c + 1]);
                 ++e) {
                const double term = matrix.value[e] * v[static_cast<std::size_t>(matrix.row[e])];
                sum += term;
                size += std::abs(term);
            }
            // An entry errs by at most 4 u; products and up to four sums add 5 u.
            const double bound = std::abs(sum) + 16 * u * size;
            residual += bound * bound;
        }
        EnclosedVector out;
        out.free = free;
        out.radius = (std::sqrt(residual) + change_ * norm(v)) / sigma_ * upwards;
        out.value = std::move(v);
        return out;
    }

    const Inspection& inspection_;
    Packing stored_;
    std::vector<double> column_error_; ///< |exact - stored unit-normal column|
    double change_ = 0;                ///< |exact - stored| for the matrix
    double sigma_ = 0;
};

using json::Json;

constexpr int vectors_in_json = 10;
constexpr int vectors_in_text = 3;
constexpr std::size_t longest = 60; ///< components of a vector shown on the terminal

/// The components that the bound distinguishes from 0.
std::vector<std::size_t> visible(const EnclosedVector& vector) {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < vector.value.size(); ++k) {
        if (std::abs(vector.value[k]) > vector.radius) {
            out.push_back(k);
        }
    }
    return out;
}

} // namespace

EnclosedBases enclose_bases(const ExactPacking& packing, const Inspection& inspection, int count) {
    // The bound of a column holds for two disks without a period between them.
    if (inspection.rank_exact != Verdict::proved || packing.cell.any()) {
        return {};
    }
    const DofMap dofs(approximate(packing));
    const exact::RankBound independent = exact::rank_bound(exact_contact_matrix(packing, dofs, inspection.contacts));
    if (independent.rank != inspection.rank) {
        return {};
    }
    return Encloser(packing, inspection).run(independent, count);
}

std::string enclosed_text(const ExactPacking& packing, const Inspection& inspection) {
    const EnclosedBases bases = enclose_bases(packing, inspection, vectors_in_text);
    if (bases.verdict != Verdict::proved) {
        return "bases                  too large to be exact, and no enclosure was proved\n";
    }
    std::string out;
    const auto print = [&out](const char* kind, const std::vector<EnclosedVector>& vectors,
                              const std::vector<std::string>& names, std::size_t count) {
        for (std::size_t v = 0; v < vectors.size(); ++v) {
            out += fmt::format("{} {} of {}: every component within {:.1e}, those beyond it:", kind, v + 1, count,
                               vectors[v].radius);
            const auto components = visible(vectors[v]);
            for (std::size_t k = 0; k < components.size() && k < longest; ++k) {
                out += fmt::format(" {}: {:.12g}{}", names[components[k]], vectors[v].value[components[k]],
                                   k + 1 < components.size() ? "," : "");
            }
            out += components.size() > longest ? fmt::format(" and {} more\n", components.size() - longest) : "\n";
        }
    };
    print("self-stress", bases.self_stresses, contact_names(inspection.contacts, packing.dimension()),
          bases.free_contacts.size());
    print("motion", bases.motions, dof_names(approximate(packing)), bases.free_dofs.size());
    return out;
}

std::string enclosed_json(const ExactPacking& packing, const Inspection& inspection) {
    const EnclosedBases bases = enclose_bases(packing, inspection, vectors_in_json);
    const auto list = [](const std::vector<EnclosedVector>& vectors, const std::vector<std::string>& names) {
        return json::array_of(vectors, [&](const EnclosedVector& vector) {
            const auto entry = [&](std::size_t k) { return Json{names[k], vector.value[k]}; };
            return Json{{"free", names[static_cast<std::size_t>(vector.free)]},
                        {"radius", vector.radius},
                        {"entries", json::array_of(visible(vector), entry)}};
        });
    };
    const Json object{
        {"verdict", to_string(bases.verdict)},
        {"self_stresses", list(bases.self_stresses, contact_names(inspection.contacts, packing.dimension()))},
        {"motions", list(bases.motions, dof_names(approximate(packing)))}};
    return object.dump();
}

} // namespace isostat::crafted
