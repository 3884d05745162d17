#pragma once
/// \file
/// What is asked of a state, the same for every rung: load and structural zeros; and what one rung of arithmetic knows
/// of the true vertex.

#include "rigidity/contact_pattern.hpp"
#include "verified/proved_structure.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// \pre of the structure: of the contacts of the state; it outlives the subject.
class Subject {
  public:
    Subject(const State& state, const IsostaticStructure& structure);

    const State& state;
    const DofMap& dofs;
    ContactPattern pattern;
    std::vector<int> loaded_rows;    ///< that carry a finite load whatever the loaded stress is
    std::vector<int> changing_rows;  ///< that the loaded stress presses on
    std::vector<unsigned char> zero; ///< per contact: the finite force is a structural zero

    [[nodiscard]] int size() const { return static_cast<int>(state.contacts.size()); }
    /// Contacts whose finite force vanishes at the same load as that of `opens`, for structural reasons (D3). `opens`
    /// itself and the contacts in `zero` are not listed.
    [[nodiscard]] std::vector<int> vanish_with(int opens) const;
};

/// One end of the supported interval, or why it is not decided.
struct LoadEndAnswer {
    std::optional<LoadEndClaim> claim;
    std::string open_question;
    int ties = 0; ///< forces of which it is not known whether they vanish earlier
};

/// The true vertex, enclosed around a centre (statement V5), with everything that is asked of it in intervals that
/// contain the true values. \pre of all but `exists`, `rung`: `exists()`.
class TrueVertex {
  public:
    virtual ~TrueVertex() = default;
    [[nodiscard]] virtual Rung rung() const = 0;
    /// Newton-Kantorovich succeeded, with radii that can be claimed of the *stored* coordinates.
    [[nodiscard]] virtual bool exists() const = 0;
    /// Maximum norm about the stored coordinates, as in `VertexClaim`.
    [[nodiscard]] virtual double radius() const = 0;
    [[nodiscard]] virtual double unique_radius() const = 0;
    /// Bound of |q* - q| in the 2-norm, q the doubles of the centre.
    [[nodiscard]] virtual double distance() const = 0;
    /// Lower bound of the smallest singular value of the contact matrix there, > 0.
    [[nodiscard]] virtual double sigma_min() const = 0;
    /// Gap of any pair.
    [[nodiscard]] virtual Interval gap(const Contact& contact) const = 0;
    /// Finite forces under the load of the state; structural zeros are [0, 0].
    virtual std::vector<Interval> forces() = 0;
    /// Forces per unit of eps.
    virtual std::vector<Interval> infinitesimal() = 0;
    /// Statement V7. \pre every force is positive or a structural zero.
    virtual LoadEndAnswer load_end(int direction) = 0;
};

/// The rungs, in the order in which they are tried. The arguments must outlive the result.
std::unique_ptr<TrueVertex> in_double(const Subject& subject, const ProvedStructure& centre);
std::unique_ptr<TrueVertex> in_double_double(const Subject& subject, const ProvedStructure& centre);
std::unique_ptr<TrueVertex> in_multiprecision(const Subject& subject, const ProvedStructure& centre);

} // namespace isostat
