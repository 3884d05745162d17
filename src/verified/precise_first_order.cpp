#include "verified/precise_first_order.hpp"

#include "contact/separation.hpp"
#include "verified/contact_system.hpp"

#include <cstdlib>

namespace isostat {

struct PreciseFirstOrder::Rung {
    Rung(int bits, const PreciseFirstOrder& of, const std::vector<Real>& start)
        : vertex(Arithmetic<Real>(bits), of.packing_, of.structure_, of.factorisation_,
                 Neighbourhood::of(of.packing_, of.structure_.contacts(), of.inverse_), start) {
        if (vertex.exists() && vertex.sigma() > 0) {
            system = std::make_unique<ContactSystem<Real>>(vertex, of.structure_, of.factorisation_);
        }
    }
    EnclosedVertex<Real> vertex;
    std::unique_ptr<ContactSystem<Real>> system; ///< null: nothing could be enclosed
};

namespace {

/// Rate of the gap of a pair that touches at the true vertex, on a motion on the degrees of freedom.
PreciseInterval gap_rate(const EnclosedVertex<Real>& vertex, const DofMap& dofs, const BoundedVector<Real>& motion,
                         const Contact& pair) {
    const Arithmetic<Real>& a = vertex.at().arithmetic();
    const auto component = [&](std::size_t coordinate) {
        const int dof = dofs.dof_of(coordinate);
        return dof < 0 ? a.number(0) : motion.value[static_cast<std::size_t>(dof)];
    };
    const auto minus = [](const Real& to, const Real& from) -> Real { return to - from; };
    const UpperBound unknown = separation_weight(pair) * motion.bound;
    const Layout layout = vertex.at().packing().layout();
    const Separation separation(pair, layout);
    if (!pair.of_disks()) {
        const Real v = component(layout.of_disk(pair.i) + static_cast<std::size_t>(pair.j));
        const Real rate = separation.of_wall(component, minus);
        return {rate, (unknown + a.unit() * (a.size(v) + a.size(rate))).real(), a.bits()};
    }
    const auto x = vertex.at().separation(pair);
    const auto w = separation.of_disks(component, minus);
    Real sum = a.number(0);
    UpperBound speed(0);
    UpperBound size(0);
    separation.for_each_coordinate([&](std::size_t coordinate, std::size_t, int multiple) {
        speed += std::abs(multiple) * a.size(component(coordinate));
    });
    for (std::size_t k = 0; k < x.size(); ++k) {
        sum += x[k] * w[k];
        speed += a.size(w[k]);
        size += a.size(x[k]);
    }
    // |x.v - x*.v*| <= |x| |v - v*| + |x - x*| |v*|; a component of x errs by at most 8 unit |x|, one of v by 8 unit
    // of `speed`; two products and sums follow.
    const UpperBound away = separation_weight(pair) * vertex.radius();
    // precision.md B14
    const UpperBound error = size * unknown + away * (speed + unknown) + 32 * a.unit() * size * speed;
    const PreciseInterval product(sum, error.real(), a.bits());
    const Real length = vertex.at().length(pair); // of x*: the pair touches
    return product / PreciseInterval(length, (a.unit() * a.size(length)).real(), a.bits());
}

/// Part of the second derivative of a zero gap due to its velocity: (|w|^2 - (n.w)^2) / D, w the relative velocity.
PreciseInterval turning(const EnclosedVertex<Real>& vertex, const DofMap& dofs, const BoundedVector<Real>& motion,
                        const Contact& pair) {
    const Arithmetic<Real>& a = vertex.at().arithmetic();
    if (!pair.of_disks()) {
        return PreciseInterval(a.bits());
    }
    const auto enclosed = [&](const Real& x, const UpperBound& radius) {
        return PreciseInterval(x, (radius + 8 * a.unit() * a.size(x)).real(), a.bits()); // 8: precision.md B14
    };
    const auto component = [&](std::size_t coordinate) {
        const int dof = dofs.dof_of(coordinate);
        return dof < 0 ? enclosed(a.number(0), 0) : enclosed(motion.value[static_cast<std::size_t>(dof)], motion.bound);
    };
    const auto x = vertex.at().separation(pair);
    UpperBound size(0);
    for (const Real& d : x) {
        size += a.size(d);
    }
    const auto w =
        Separation(pair, vertex.at().packing().layout())
            .of_disks(component, [](const PreciseInterval& to, const PreciseInterval& from) -> PreciseInterval {
                return to - from;
            });
    const UpperBound off = separation_weight(pair) * vertex.radius() + 8 * a.unit() * size;
    PreciseInterval square(a.bits());
    PreciseInterval along(a.bits());
    for (std::size_t k = 0; k < x.size(); ++k) {
        square = square + w[k] * w[k];
        along = along + enclosed(x[k], off) * w[k];
    }
    const PreciseInterval length = enclosed(vertex.at().length(pair), 0);
    return (square - along * along / (length * length)) / length;
}

} // namespace

PreciseFirstOrder::PreciseFirstOrder(const Packing& packing, const IsostaticStructure& structure,
                                     const Factorisation& factorisation, const InverseBound& inverse,
                                     const LadderOptions& options)
    : packing_(packing), structure_(structure), factorisation_(factorisation), inverse_(inverse), options_(options) {}

PreciseFirstOrder::~PreciseFirstOrder() = default;

PreciseFirstOrder::Rung* PreciseFirstOrder::rung(int number) {
    const auto index = static_cast<std::size_t>(number);
    while (rungs_.size() <= index) {
        const int bits = options_.first_bits << rungs_.size();
        const std::vector<Real> start = rungs_.empty() ? std::vector<Real>() : rungs_.back()->vertex.at().correction();
        rungs_.push_back(std::make_unique<Rung>(bits, *this, start));
    }
    return rungs_[index]->system ? rungs_[index].get() : nullptr;
}

Enclosure PreciseFirstOrder::climb(const std::vector<Sum>& approach, const Sum& grown, const Contact& pair) {
    Enclosure result{0, std::numeric_limits<double>::infinity()};
    for (int number = 0; options_.first_bits << number <= options_.max_bits && !result.decided(); ++number) {
        const Rung* at = rung(number);
        if (at == nullptr) {
            break;
        }
        const Arithmetic<Real>& a = at->vertex.at().arithmetic();
        bool exact = true; // false: the two addends are too far apart for these bits
        const auto sum = [&](const Sum& two) {
            Real total(a.bits());
            exact = mpfr_add(total.get(), a.number(two[0]).get(), a.number(two[1]).get(), MPFR_RNDN) == 0 && exact;
            return total;
        };
        std::vector<Real> right;
        std::transform(approach.begin(), approach.end(), std::back_inserter(right), sum);
        const PreciseInterval own(sum(grown), Real(), a.bits());
        const BoundedVector<Real> motion = at->system->motion(right);
        if (exact && !motion.value.empty()) {
            result = (gap_rate(at->vertex, structure_.dofs(), motion, pair) - own).rounded();
        }
    }
    return result;
}

PreciseFirstOrder::Sum PreciseFirstOrder::grown(const std::vector<double>& rho, const Contact& pair) {
    return pair.kind == ContactKind::held
               ? Sum{0, 0}
               : Sum{rho[static_cast<std::size_t>(pair.i)],
                     pair.kind == ContactKind::disk_disk ? rho[static_cast<std::size_t>(pair.j)] : 0};
}

Enclosure PreciseFirstOrder::rate(ContactId opened, int direction, const Contact& pair) {
    std::vector<Sum> approach(structure_.contacts().size(), Sum{0, 0});
    approach[opened.index()][0] = -direction;
    return climb(approach, {0, 0}, pair);
}

Enclosure PreciseFirstOrder::bend(ContactId opened, int direction, const Contact& pair) {
    const Rung* at = rung(0);
    const Enclosure unknown{0, std::numeric_limits<double>::infinity()};
    if (at == nullptr) {
        return unknown;
    }
    const Arithmetic<Real>& a = at->vertex.at().arithmetic();
    const auto& contacts = structure_.contacts();
    std::vector<Real> approach(contacts.size(), a.number(0));
    approach[opened.index()] = a.number(-direction);
    const BoundedVector<Real> velocity = at->system->motion(approach);
    if (velocity.value.empty()) {
        return unknown;
    }
    // The gaps of the contacts stay constant, and the gap of `opened` grows at a constant rate: g.w + turning = 0.
    std::vector<UpperBound> open;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const PreciseInterval t = turning(at->vertex, structure_.dofs(), velocity, contacts[l]);
        approach[l] = t.low;
        open.push_back(UpperBound::magnitude((t - PreciseInterval(t.low, Real(), a.bits())).high));
    }
    BoundedVector<Real> acceleration = at->system->motion(approach);
    if (acceleration.value.empty()) {
        return unknown;
    }
    constexpr double rounded_up = 1 + 0x1p-50; // precision.md B1 (last operations)
    acceleration.bound += norm_of_bounds(open) / at->vertex.sigma() * rounded_up;
    return (gap_rate(at->vertex, structure_.dofs(), acceleration, pair) +
            turning(at->vertex, structure_.dofs(), velocity, pair))
        .rounded();
}

Enclosure PreciseFirstOrder::gap(const std::vector<double>& rho, const Contact& pair) {
    std::vector<Sum> approach;
    for (const Contact& c : structure_.contacts()) {
        const Sum sum = grown(rho, c);
        approach.push_back({-sum[0], -sum[1]});
    }
    return climb(approach, grown(rho, pair), pair);
}

} // namespace isostat
