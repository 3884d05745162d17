#include "statics/steepest.hpp"

#include "core/roundoff.hpp"
#include "verified/force_solution.hpp"
#include "verified/norm.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::infinity;
using roundoff::u;

/// The mechanism that opens a contact at unit rate (the held and kept others at rest), and its 2-norm, enclosed.
struct Mechanism {
    std::vector<double> velocity;
    Enclosure norm;
};

template <int Dim> Mechanism mechanism_of(const Statics<Dim>& statics, ContactId l) {
    const sparse::Matrix<double>& h = statics.structure().matrix();
    std::vector<double> v(static_cast<std::size_t>(h.rows), 0.0);
    v[l.index()] = 1;
    statics.factorisation().solve_velocities(v);
    double residual = 0;
    double size = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        double dot = j == l.index() ? -1.0 : 0.0;
        double terms = std::abs(dot);
        for (int e = h.start[j]; e < h.start[j + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            const double term = h.value[s] * v[static_cast<std::size_t>(h.row[s])];
            dot += term;
            terms += std::abs(term);
        }
        const double bound = std::abs(dot) + 12 * u * terms; // at most 4 terms, 5u per entry
        residual += bound * bound;
    }
    for (const double c : v) {
        size += c * c;
    }
    const double value = std::sqrt(size);
    const double away = statics.normal_uncertainty();
    const double sigma = statics.inverse().sigma_min - away;
    const double error = (std::sqrt(residual) + away * value) * (1 + 1e-10);
    return {std::move(v), {value, sigma > 0 ? error / sigma * (1 + 1e-10) + 1e-10 * value : infinity}};
}

/// The contender that may have the smallest key gets it, until no other may.
template <int Dim> class SteepestSearch {
  public:
    SteepestSearch(const Statics<Dim>& statics, std::vector<Contender>& contenders)
        : statics_(statics), contenders_(contenders), has_key_(contenders.size(), 0), speed_(contenders.size(), 0) {}

    void run() {
        constexpr std::size_t worth = 4; // cost: a solve that bounds the others against a solve for each of them
        std::size_t left = contenders_.size();
        for (auto next = lowest(); next && !(floor(*next) > ceiling_); next = lowest()) {
            const Mechanism mechanism = mechanism_of(statics_, contenders_[*next].contact);
            Enclosure& key = contenders_[*next].key;
            key = quotient(contenders_[*next].force, mechanism.norm);
            has_key_[*next] = 1;
            if (key.value + key.radius < ceiling_) {
                ceiling_ = (key.value + key.radius) * (1 - 4 * u * (key.value < 0 ? 1 : -1));
            }
            if (--left > worth) {
                bound_speeds(mechanism.velocity);
            }
        }
        std::size_t k = 0;
        std::erase_if(contenders_, [&](const Contender&) { return has_key_[k++] == 0; });
    }

  private:
    /// Below the key of a contender that has none yet. 0: its force may be positive.
    [[nodiscard]] double floor(std::size_t k) const {
        const Enclosure& f = contenders_[k].force;
        const double lower = f.value - f.radius;
        return lower < 0 ? lower / speed_[k] * (1 + 4 * u) : 0;
    }

    /// The one without a key that may have the smallest.
    [[nodiscard]] std::optional<std::size_t> lowest() const {
        std::optional<std::size_t> best;
        const auto before = [&](std::size_t a, std::size_t b) {
            const double x = floor(a), y = floor(b);
            return x < y || (x == y && contenders_[a].force.value < contenders_[b].force.value);
        };
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            if (has_key_[k] == 0 && (!best || before(k, *best))) {
                best = k;
            }
        }
        return best;
    }

    /// Lower bounds of |v_l| = |G^-1 e_l|, of all l at once: w . v_l is the force in l that balances the load w, and
    /// |w . v_l| <= |w| |v_l|.
    void bound_speeds(const std::vector<double>& w) {
        const InverseBound& inverse = statics_.inverse();
        const double away = statics_.normal_uncertainty();
        const double sigma = inverse.sigma_min - away;
        if (!(sigma > 0)) {
            return;
        }
        const ForceSolution p = solve_forces(statics_.structure(), statics_.factorisation(), inverse, w);
        const double error = (p.bound * inverse.sigma_min + away * norm_above(p.value)) / sigma * (1 + 1e-10);
        const double size = norm_above(w);
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            const double projected = (std::abs(p.value[contenders_[k].contact.index()]) - error) / size * (1 - 4 * u);
            speed_[k] = projected > speed_[k] ? projected : speed_[k];
        }
    }

    const Statics<Dim>& statics_;
    std::vector<Contender>& contenders_;
    std::vector<unsigned char> has_key_;
    std::vector<double> speed_; ///< below |v|
    double ceiling_ = infinity; ///< above the smallest key
};

} // namespace

Enclosure quotient(const Enclosure& a, const Enclosure& b) {
    const double value = a.value / b.value;
    const double smallest = b.value - b.radius;
    if (!(smallest > 0)) {
        return {value, infinity};
    }
    return {value, (a.radius + std::abs(value) * b.radius) / smallest * (1 + 8 * u) + 2 * u * std::abs(value)};
}

template <int Dim> void keep_steepest(const Statics<Dim>& statics, std::vector<Contender>& contenders) {
    SteepestSearch<Dim>(statics, contenders).run();
}

template void keep_steepest<2>(const Statics<2>&, std::vector<Contender>&);

} // namespace isostat
