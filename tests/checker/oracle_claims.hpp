#pragma once
// Whether claims agree with approximations: what a checker must never prove against.

#include "checker/maker.hpp"

namespace maker {

/// Empty, or what is wrong with a claim of the certificate beyond a relative 1e-9. The approximations are made again
/// from the state.
inline std::string contradiction(const Certificate& certificate) {
    const Certificate own = maker::certificate(certificate.state);
    const auto& claims = certificate.claims;
    const auto& truth = own.claims;
    const auto outside = [](const Interval& claimed, const Interval& true_range) {
        const double middle = (true_range.lower + true_range.upper) / 2;
        const double room = 1e-9 * std::max(1.0, std::abs(middle));
        return !(claimed.lower <= middle + room && middle - room <= claimed.upper);
    };
    if (claims.counting && (claims.counting->dof_count != truth.counting->dof_count ||
                            claims.counting->contact_count != truth.counting->contact_count ||
                            claims.counting->rank != truth.counting->rank)) {
        return "counting";
    }
    if (claims.vertex && claims.vertex->radius < truth.vertex->radius * 0.99 - 2e-15) {
        return "radius";
    }
    if (claims.forces) {
        if (claims.forces->structural_zeros != truth.forces->structural_zeros) {
            return "structural zeros";
        }
        for (std::size_t l = 0; l < truth.forces->finite.size(); ++l) {
            if (outside(claims.forces->finite[l], truth.forces->finite[l])) {
                return "force " + std::to_string(l);
            }
            const bool zero = std::binary_search(truth.forces->structural_zeros.begin(),
                                                 truth.forces->structural_zeros.end(), static_cast<int>(l));
            if (!zero && !(truth.forces->finite[l].upper > 0)) {
                return "negative force " + std::to_string(l);
            }
        }
        for (std::size_t k = 0; k < truth.forces->infinitesimal.size(); ++k) {
            if (outside(claims.forces->infinitesimal[k], truth.forces->infinitesimal[k]) ||
                !(truth.forces->infinitesimal[k].upper > 0)) {
                return "infinitesimal force " + std::to_string(k);
            }
        }
    }
    if (claims.gaps &&
        (!(claims.gaps->smallest <= truth.gaps->smallest + 1e-9) || claims.gaps->where != truth.gaps->where)) {
        return "gaps";
    }
    if (claims.load_interval) {
        const auto wrong = [&outside](const isostat::LoadEndClaim& claimed, const isostat::LoadEndClaim& true_end) {
            return claimed.unbounded != true_end.unbounded ||
                   (!claimed.unbounded &&
                    (outside(claimed.stress, true_end.stress) || claimed.opens != true_end.opens));
        };
        if (wrong(claims.load_interval->low, truth.load_interval->low) ||
            wrong(claims.load_interval->high, truth.load_interval->high)) {
            return "load interval";
        }
    }
    return "";
}

} // namespace maker
