#pragma once
// Claims of a certificate against the true vertex.

#include "oracle/truth.hpp"

#include <isostat/io/state_file.hpp>

#include <iomanip>
#include <sstream>
#include <string>

namespace isostat::oracle {

inline std::string text(const Real& x) {
    std::ostringstream stream;
    stream << std::setprecision(20) << x;
    return stream.str();
}

/// Up to what the digits leave open of a number of that scale.
inline bool inside(const Interval& i, const Real& x, const Real& scale = 1) {
    const Real room = negligible<Real> * scale;
    return Real(i.lower) <= x + room && x - room <= Real(i.upper);
}

/// What is claimed and not true, in words; of counts nothing, which are those of the stored coordinates.
/// \pre the truth is known
inline std::vector<std::string> objections(const CertificateClaims& claims, const State& state, const Truth& truth) {
    std::vector<std::string> wrong;
    if (claims.vertex && Real(claims.vertex->radius) < truth.moved) {
        wrong.push_back("the true vertex is " + text(truth.moved) + " away, claimed " +
                        std::to_string(claims.vertex->radius));
    }
    if (claims.forces) {
        std::size_t zeros = 0;
        const auto& structural = claims.forces->structural_zeros;
        for (std::size_t l = 0; l < claims.forces->finite.size(); ++l) {
            const std::string force = "force of " + to_string(state.contacts[l]) + " is ";
            if (!inside(claims.forces->finite[l], truth.force[l], truth.force_scale)) {
                wrong.push_back(force + text(truth.force[l]));
            }
            const bool zero = zeros < structural.size() && structural[zeros] == static_cast<int>(l);
            if (sign_of(truth.force[l], truth.force_scale) != (zero ? 0 : 1)) {
                wrong.push_back(force + (zero ? "no zero: " : "not positive: ") + text(truth.force[l]));
            }
            if (zero &&
                !(inside(claims.forces->infinitesimal[zeros], truth.infinitesimal[l]) && truth.infinitesimal[l] > 0)) {
                wrong.push_back("infinitesimal " + force + text(truth.infinitesimal[l]));
            }
            zeros += zero ? 1 : 0;
        }
        if (zeros != structural.size()) {
            wrong.push_back("a structural zero is no contact, or is named twice");
        }
    }
    if (const auto* nearest = truth.nearest(); claims.gaps && nearest != nullptr) {
        if (Real(claims.gaps->smallest) > nearest->gap) {
            wrong.push_back("smallest gap is " + text(nearest->gap) + ", claimed at least " +
                            std::to_string(claims.gaps->smallest));
        }
        if (abs(truth.gap(claims.gaps->where) - nearest->gap) > nearest->gap * Real(1e-6) + Real(1e-13)) {
            wrong.push_back("the smallest gap is not that of " + to_string(claims.gaps->where));
        }
    }
    const auto end = [&](const LoadEndClaim& claim, const Truth::End& real, const std::string& name) {
        if (claim.unbounded || real.unbounded) {
            if (claim.unbounded != real.unbounded) {
                wrong.push_back(name + " end of the interval: bounded or not");
            }
            return;
        }
        if (!inside(claim.stress, real.stress)) {
            wrong.push_back(name + " end of the interval is " + text(real.stress));
        }
        // Several forces may vanish there: the contact named is one of theirs.
        const bool opens = std::ranges::any_of(
            real.opens, [&](int l) { return state.contacts[static_cast<std::size_t>(l)] == claim.opens; });
        if (!opens) {
            wrong.push_back(name + " end opens another contact than " + to_string(claim.opens));
        }
    };
    if (claims.load_interval) {
        end(claims.load_interval->low, truth.low, "lower");
        end(claims.load_interval->high, truth.high, "upper");
    }
    return wrong;
}

} // namespace isostat::oracle
