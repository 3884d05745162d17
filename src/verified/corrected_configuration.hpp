#pragma once
// Gaps and contact matrix at stored coordinates plus a correction, in one number type: private to the room and to the
// certificate. V5 and V6 (proofs/true_vertex.md) derive every constant.

#include "contact/separation.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/arithmetic.hpp"
#include "verified/vertex_bounds.hpp"

#include <array>
#include <vector>

namespace isostat {

/// c = q + p, q doubles. Differences of coordinates are formed as (q_j - q_i) + (p_j - p_i), so that large coordinates
/// do not cancel, whatever the distance from the origin. With an image x_j - x_i + A m of the doubles is formed first:
/// it is exact in every arithmetic where they are on the grid, which cells must be. `Correction`: the type of p, one
/// number per coordinate. Copies share the packing, which must outlive them.
template <class T, class Correction = std::vector<T>> class CorrectedConfiguration {
  public:
    /// p = 0.
    CorrectedConfiguration(const Arithmetic<T>& arithmetic, const Packing& packing)
        : arithmetic_(arithmetic), packing_(&packing), correction_(packing.q.size(), arithmetic.number(0)) {}
    CorrectedConfiguration(const Arithmetic<T>& arithmetic, const Packing& packing, Correction correction)
        : arithmetic_(arithmetic), packing_(&packing), correction_(std::move(correction)) {}

    [[nodiscard]] const Arithmetic<T>& arithmetic() const { return arithmetic_; }
    [[nodiscard]] const Packing& packing() const { return *packing_; }
    [[nodiscard]] const Correction& correction() const { return correction_; }
    [[nodiscard]] T& correction(int coordinate) { return correction_[index(coordinate)]; }
    void correct(Correction correction) { correction_ = std::move(correction); }

    /// F_l of T9: (|x_j - x_i|^2 - D^2) / (2 D), the gap at a wall, the change of a held coordinate. Within 8 unit D.
    [[nodiscard]] T gap_function(const Contact& contact) const {
        return contact.of_disks()  ? power(contact) / (number(2) * length(contact))
               : contact.is_wall() ? wall_gap(contact)
                                   : moved(index(contact.i));
    }
    /// |x_j - x_i|^2 - D^2.
    [[nodiscard]] T power(const Contact& contact) const {
        const T d = length(contact);
        return square(contact) - d * d;
    }
    /// Gap of a disk and a wall.
    [[nodiscard]] T wall_gap(const Contact& contact) const {
        const double r = packing_->radius[index(contact.i)];
        if (contact.wall().at_length) {
            const T x =
                Separation(contact, packing_->layout())
                    .of_wall_at_length([](std::size_t coordinate) { return coordinate; },
                                       [this](std::size_t to, std::size_t from) { return difference(from, to); });
            return x - number(r);
        }
        const std::size_t k = packing_->layout().of_disk(contact.i) + index(contact.j);
        return arithmetic_.difference(packing_->q[k], r) + moved(k);
    }
    /// Gap of any pair, within 8 unit (|gap| + D) and the rounding of a quotient and a root.
    [[nodiscard]] T gap(const Contact& contact) const {
        using std::sqrt;
        return contact.of_disks()  ? power(contact) / (sqrt(square(contact)) + length(contact))
               : contact.is_wall() ? wall_gap(contact)
                                   : number(0);
    }
    /// x_j - x_i + A m of two disks: first the stored numbers, as large ones cancel, then the corrections.
    [[nodiscard]] PerAxis<T> separation(const Contact& pair) const {
        const Separation separation(pair, packing_->layout());
        if (pair.image.is_here()) [[likely]] {
            return separation.of_centres([](std::size_t coordinate) { return coordinate; },
                                         [this](std::size_t to, std::size_t from) { return difference(from, to); });
        }
        const auto minus = [](const T& a, const T& b) -> T { return a - b; };
        auto r = separation.of_disks([this](std::size_t k) { return number(packing_->q[k]); }, minus);
        const auto p = separation.of_disks([this](std::size_t k) { return moved(k); }, minus);
        for (std::size_t a = 0; a < r.size(); ++a) {
            r[a] += p[a];
        }
        return r;
    }
    /// R_i + R_j, or the length of a bar.
    [[nodiscard]] T length(const Contact& contact) const {
        if (contact.kind == ContactKind::bar) {
            return number(packing_->bar_length(contact.i, contact.j));
        }
        return number(packing_->radius[index(contact.i)]) + number(packing_->radius[index(contact.j)]);
    }

    /// Columns of disk contacts are (x_j - x_i) divided by a length. by_lengths: A(c) = -DF(c)^T, which is the contact
    /// matrix if c is the true vertex (V6). by_distances: the unit normals at c.
    enum class Divided : unsigned char { by_lengths, by_distances };
    [[nodiscard]] sparse::Matrix<T> contact_matrix(const IsostaticStructure& structure, Divided divided) const {
        using std::sqrt;
        const sparse::Matrix<double>& h = structure.matrix();
        sparse::Matrix<T> matrix{h.rows, h.cols, h.start, h.row, {}};
        for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
            const Contact& contact = structure.contacts()[l];
            if (!contact.of_disks()) {
                for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                    matrix.value.push_back(number(h.value[index(e)])); // +-1
                }
                continue;
            }
            const T by = divided == Divided::by_lengths ? length(contact) : sqrt(square(contact));
            auto normal = separation(contact);
            for (T& component : normal) {
                component = component / by;
            }
            Separation(contact, packing_->layout()).for_each_entry(structure.dofs(), normal, [&](int, const T& entry) {
                matrix.value.push_back(entry);
            });
        }
        return matrix;
    }

  private:
    static std::size_t index(int k) { return static_cast<std::size_t>(k); }
    /// x_to - x_from.
    [[nodiscard]] T difference(std::size_t from, std::size_t to) const {
        return arithmetic_.difference(packing_->q[to], packing_->q[from]) + (moved(to) - moved(from));
    }
    [[nodiscard]] T moved(std::size_t coordinate) const { return T(correction_[coordinate]); }
    [[nodiscard]] T number(double x) const { return arithmetic_.number(x); }
    [[nodiscard]] T square(const Contact& contact) const {
        T sum = number(0);
        for (const T& d : separation(contact)) {
            sum += d * d;
        }
        return sum;
    }

    Arithmetic<T> arithmetic_;
    const Packing* packing_;
    Correction correction_;
};

} // namespace isostat
