#include "crafted/inspection_parts.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace isostat::crafted {

namespace {

using exact::Number;
using Row = std::array<Number, most_axes + most_tilts>; ///< translations, then turns in the planes of two axes

/// Rows, and the number of independent ones among those added so far.
class Span {
  public:
    void add(Row row) {
        for (const auto& [pivot, known] : rows_) {
            const Number factor = row[pivot];
            for (std::size_t k = 0; k < row.size() && !factor.is_zero(); ++k) {
                row[k] -= factor * known[k];
            }
        }
        const auto entry = std::ranges::find_if(row, [](const Number& x) { return !x.is_zero(); });
        if (entry != row.end()) {
            const Number scale = entry->inverse();
            const auto pivot = static_cast<std::size_t>(entry - row.begin());
            for (Number& x : row) {
                x *= scale;
            }
            rows_.emplace_back(pivot, std::move(row));
        }
    }
    [[nodiscard]] int rank() const { return static_cast<int>(rows_.size()); }

  private:
    std::vector<std::pair<std::size_t, Row>> rows_;
};

/// The common motions that walls and periods allow. A movable wall follows a translation, and prevents a rotation.
class Freedom {
  public:
    explicit Freedom(const Packing& packing) : axes_(packing.axes()) {
        for (std::size_t a = 0; a < axes_; ++a) {
            const WallKind lower = packing.walls.lower[a], upper = packing.walls.upper[a];
            moves_[a] = lower != WallKind::fixed && upper != WallKind::fixed && !packing.cell.periodic[a];
            open_[a] = moves_[a] && lower == WallKind::absent && upper == WallKind::absent;
        }
    }
    [[nodiscard]] int count() const {
        const auto open = std::ranges::count(open_, true);
        return static_cast<int>(std::ranges::count(moves_, true) + open * (open - 1) / 2);
    }
    /// The motion of a point along each axis.
    [[nodiscard]] PerAxis<Row> of(const PerAxis<Number>& x) const {
        PerAxis<Row> out;
        for (std::size_t b = 0; b < axes_; ++b) {
            out[b][b] = Number(moves_[b] ? 1 : 0);
            for (std::size_t a = 0; a < b && open_[b]; ++a) {
                if (open_[a]) {
                    out[a][most_axes + Cell::tilt(a, b)] = -x[b];
                    out[b][most_axes + Cell::tilt(a, b)] = x[a];
                }
            }
        }
        return out;
    }

  private:
    std::size_t axes_;
    PerAxis<bool> moves_{}, open_{};
};

} // namespace

int rigid_motions(const Packing& packing, const std::function<bool(int)>& takes_part,
                  const std::function<Number(std::size_t)>& at) {
    const Freedom freedom(packing);
    Span span;
    const auto add = [&](int i) {
        PerAxis<Number> x;
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            x[a] = at(packing.layout().of_disk(i) + a);
        }
        for (Row& row : freedom.of(x)) {
            span.add(std::move(row));
        }
    };
    const auto add_all = [&](bool fixed) {
        for (int i = 0; i < packing.disk_count() && span.rank() < freedom.count(); ++i) {
            if (packing.is_fixed(DiskId(i)) == fixed && (fixed || takes_part(i))) {
                add(i);
            }
        }
        return span.rank();
    };
    const int taken = add_all(true); // number of motions that fixed grains prevent
    return add_all(false) - taken;
}

} // namespace isostat::crafted
