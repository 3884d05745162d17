#include "crafted/peeling.hpp"

#include "contact/separation.hpp"

#include <isostat/core/error.hpp>
#include <isostat/exact/number.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace isostat::crafted {

namespace {

using exact::Number;

/// Difference of two stored points: the rounded difference, whether this is exact, and the exact one on request.
struct StoredNormal {
    std::array<double, 2> d{};
    std::array<double, 2> from{}, to{};
    bool exact = true; ///< d is the exact difference
    /// The difference of a disk and an image, which is no difference of two doubles.
    std::shared_ptr<const std::array<Number, 2>> of_image;

    /// Rounds r: d has the sign of r and is within 1 ulp of r.
    explicit StoredNormal(const std::array<Number, 2>& r) : of_image(std::make_shared<std::array<Number, 2>>(r)) {
        for (std::size_t k = 0; k < 2; ++k) {
            d[k] = r[k].to_double();
            exact = exact && (Number::from_double(d[k]) - r[k]).is_zero();
        }
    }

    StoredNormal(const std::array<double, 2>& a, const std::array<double, 2>& b) : from(a), to(b) {
        for (std::size_t k = 0; k < 2; ++k) {
            d[k] = b[k] - a[k];
            // Knuth's error of a sum; 0 exactly when the difference is not rounded.
            const double bb = d[k] + a[k];
            exact = exact && (a[k] - (bb - d[k])) + (b[k] - bb) == 0;
        }
    }
    [[nodiscard]] Number number(std::size_t k) const {
        return of_image ? (*of_image)[k] : Number::from_double(to[k]) - Number::from_double(from[k]);
    }
};

constexpr double no_underflow = 0x1p-900; ///< products above this have an exact rounding error

/// Sign of a b - c d; `factors` says whether the factors are exact or stand for differences.
template <class Exact> int difference_of_products(double a, double b, double c, double d, bool factors, Exact exact) {
    // A rounded difference has the sign of the difference, and is 0 only if the difference is.
    const auto sign = [](double x) { return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0); };
    const int left = sign(a) * sign(b), right = sign(c) * sign(d);
    if (left != right) {
        return left > right ? 1 : -1;
    }
    if (left == 0) {
        return 0;
    }
    const double p = a * b;
    const double q = c * d;
    const double size = std::abs(p) + std::abs(q);
    if (size > no_underflow && std::isfinite(size)) {
        // Differences and product: 3 roundings of 2^-53 each (of images 5), and one of p - q.
        if (std::abs(p - q) > 0x1p-49 * size) {
            return p > q ? 1 : -1;
        }
        // Rounding keeps the order, so only equal products need their errors, which fma gives exactly.
        if (factors && std::min(std::abs(p), std::abs(q)) > no_underflow) {
            const double e = std::fma(a, b, -p);
            const double f = std::fma(c, d, -q);
            return p != q ? (p > q ? 1 : -1) : (e > f ? 1 : 0) - (e < f ? 1 : 0);
        }
    }
    return exact().sign();
}

int cross_sign(const StoredNormal& a, const StoredNormal& b) {
    return difference_of_products(a.d[0], b.d[1], a.d[1], b.d[0], a.exact && b.exact,
                                  [&] { return a.number(0) * b.number(1) - a.number(1) * b.number(0); });
}
int dot_sign(const StoredNormal& a, const StoredNormal& b) {
    return difference_of_products(a.d[0], b.d[0], -a.d[1], b.d[1], a.exact && b.exact,
                                  [&] { return a.number(0) * b.number(0) + a.number(1) * b.number(1); });
}

/// 0 for an angle in [0, pi), 1 in [pi, 2 pi). The sign of a rounded difference is that of the difference.
int half(const StoredNormal& a) {
    return a.d[1] > 0 || (a.d[1] == 0 && a.d[0] > 0) ? 0 : 1;
}

struct Arm {
    int contact;
    StoredNormal normal;
};

/// The contacts of one disk ordered by angle, as a ring of arms.
class Ring {
  public:
    void add(int contact, const StoredNormal& normal) { arms_.push_back({contact, normal}); }

    void close() {
        std::sort(arms_.begin(), arms_.end(), [](const Arm& a, const Arm& b) {
            const int ha = half(a.normal), hb = half(b.normal);
            if (ha != hb) {
                return ha < hb;
            }
            const int turn = cross_sign(a.normal, b.normal);
            return turn != 0 ? turn > 0 : a.contact < b.contact;
        });
        const std::size_t z = arms_.size();
        next_.resize(z);
        previous_.resize(z);
        alive_.assign(z, 1);
        for (std::size_t k = 0; k < z; ++k) {
            next_[k] = (k + 1) % z;
            previous_[k] = (k + z - 1) % z;
        }
    }

    /// The arm after the widest opening when an opening is at least pi (or there is one arm only); otherwise -1.
    [[nodiscard]] int wide_opening() const {
        int last = -1;
        for (std::size_t k = 0; k < arms_.size(); ++k) {
            if (alive_[k] != 0 && opens(previous_[k], k)) {
                last = static_cast<int>(k);
            }
        }
        return last;
    }

    /// Whether the angle from arm a, counterclockwise, to its follower b is at least pi.
    [[nodiscard]] bool opens(std::size_t a, std::size_t b) const {
        if (a == b) {
            return true;
        }
        const int turn = cross_sign(arms_[a].normal, arms_[b].normal);
        if (turn != 0) {
            return turn < 0;
        }
        if (dot_sign(arms_[a].normal, arms_[b].normal) < 0) {
            return true;
        }
        // Equal directions: the angle is 0, except from the last arm to the first when all arms have this direction.
        return a >= b && std::all_of(arms_.begin(), arms_.end(), [&](const Arm& arm) {
                   const auto k = static_cast<std::size_t>(&arm - arms_.data());
                   return alive_[k] == 0 ||
                          (cross_sign(arms_[a].normal, arm.normal) == 0 && dot_sign(arms_[a].normal, arm.normal) > 0);
               });
    }

    void remove(std::size_t k) {
        alive_[k] = 0;
        next_[previous_[k]] = next_[k];
        previous_[next_[k]] = previous_[k];
    }

    [[nodiscard]] std::size_t find(int contact) const {
        std::size_t k = 0;
        while (arms_[k].contact != contact || alive_[k] == 0) {
            ++k;
        }
        return k;
    }

    [[nodiscard]] bool alive(std::size_t k) const { return alive_[k] != 0; }
    [[nodiscard]] std::size_t size() const { return arms_.size(); }
    [[nodiscard]] const Arm& arm(std::size_t k) const { return arms_[k]; }
    [[nodiscard]] std::size_t next(std::size_t k) const { return next_[k]; }
    [[nodiscard]] std::size_t previous(std::size_t k) const { return previous_[k]; }

  private:
    std::vector<Arm> arms_;
    std::vector<std::size_t> next_, previous_;
    std::vector<unsigned char> alive_;
};

enum class Hold { held, bridge, rattler, fixed };

class Peeler {
  public:
    Peeler(const Packing& packing, const std::vector<Contact>& contacts)
        : packing_(packing), contacts_(contacts), rings_(packing.radius.size()),
          hold_(packing.radius.size(), Hold::held), carrying_(contacts.size(), 1) {
        out_.contact_from.assign(contacts.size(), 0);
        out_.disk_from.assign(rings_.size(), 0);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            add_arms(static_cast<int>(l));
        }
        for (std::size_t i = 0; i < rings_.size(); ++i) {
            rings_[i].close();
            if (packing.is_fixed(DiskId(i))) {
                hold_[i] = Hold::fixed;
            }
        }
    }

    Peeling run() {
        now_ = static_cast<int>(contacts_.size());
        for (std::size_t i = 0; i < rings_.size(); ++i) {
            if (hold_[i] == Hold::held) {
                judge(i);
            }
        }
        settle();
        for (int l = now_; l-- > 0;) {
            now_ = l; // the list has one contact less: what fails from here on needs more than l contacts
            drop(l);
            settle();
        }
        return std::move(out_);
    }

  private:
    void add_arms(int l) {
        const Contact& contact = contacts_[static_cast<std::size_t>(l)];
        const auto i = static_cast<std::size_t>(contact.i);
        const auto j = static_cast<std::size_t>(contact.j);
        if (contact.of_disks() && !contact.image.is_here()) {
            add_arms_of_image(l);
        } else if (contact.of_disks()) {
            const std::array<double, 2> a{packing_.q[2 * i], packing_.q[2 * i + 1]};
            const std::array<double, 2> b{packing_.q[2 * j], packing_.q[2 * j + 1]};
            if (a == b) {
                throw Error(ErrorKind::bad_input,
                            fmt::format("disks {} and {} have the same centre ({}, {})", i, j, a[0], a[1]));
            }
            rings_[i].add(l, StoredNormal(a, b));
            rings_[j].add(l, StoredNormal(b, a));
        } else {
            std::array<double, 2> unit{};
            unit[j] = contact.kind == ContactKind::lower_wall ? -1 : 1;
            rings_[i].add(l, StoredNormal({0, 0}, unit));
        }
    }

    void add_arms_of_image(int l) {
        const Contact& contact = contacts_[static_cast<std::size_t>(l)];
        if (contact.i == contact.j) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("disk {} is near its own image: expected a cell that is larger than the largest "
                                    "disk and the threshold",
                                    contact.i));
        }
        const auto minus = [](const Number& a, const Number& b) -> Number { return a - b; };
        const auto r = Separation(contact, packing_.layout())
                           .of_disks([&](std::size_t k) { return Number::from_double(packing_.q[k]); }, minus);
        if (r[0].is_zero() && r[1].is_zero()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("disk {} and an image of disk {} have the same centre", contact.i, contact.j));
        }
        rings_[static_cast<std::size_t>(contact.i)].add(l, StoredNormal({r[0], r[1]}));
        rings_[static_cast<std::size_t>(contact.j)].add(l, StoredNormal({-r[0], -r[1]}));
    }

    /// Removes a contact that carried a force with `now_` + 1 contacts and cannot with `now_`.
    void drop(int l) {
        if (carrying_[static_cast<std::size_t>(l)] == 0) {
            return;
        }
        carrying_[static_cast<std::size_t>(l)] = 0;
        out_.contact_from[static_cast<std::size_t>(l)] = now_ + 1;
        const Contact& contact = contacts_[static_cast<std::size_t>(l)];
        take_arm(static_cast<std::size_t>(contact.i), l);
        if (contact.of_disks()) {
            take_arm(static_cast<std::size_t>(contact.j), l);
        }
    }

    void take_arm(std::size_t disk, int l) {
        Ring& ring = rings_[disk];
        const std::size_t k = ring.find(l);
        const std::size_t before = ring.previous(k), after = ring.next(k);
        ring.remove(k);
        if (hold_[disk] == Hold::bridge || (hold_[disk] == Hold::held && (before == k || ring.opens(before, after)))) {
            waiting_.push_back(disk);
        }
    }

    void settle() {
        while (!waiting_.empty()) {
            const std::size_t disk = waiting_.back();
            waiting_.pop_back();
            judge(disk);
        }
    }

    void judge(std::size_t disk) {
        if (hold_[disk] == Hold::rattler || hold_[disk] == Hold::fixed) {
            return;
        }
        Ring& ring = rings_[disk];
        const int after = ring.wide_opening();
        bool any = false;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            any = any || ring.alive(k);
        }
        if (after < 0 && any) {
            hold_[disk] = Hold::held;
            return;
        }
        // All normals are in the half-plane that the opening leaves. Therefore only its border carries forces, and only
        // when arms point in both directions of the border.
        bool bridge = false;
        if (any) {
            const auto b = static_cast<std::size_t>(after);
            const StoredNormal& last = ring.arm(ring.previous(b)).normal;
            bridge = ring.previous(b) != b && cross_sign(last, ring.arm(b).normal) == 0 &&
                     dot_sign(last, ring.arm(b).normal) < 0;
        }
        hold_[disk] = bridge ? Hold::bridge : Hold::rattler;
        if (!bridge) {
            out_.disk_from[disk] = now_ + 1;
        }
        std::vector<int> lost;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            if (ring.alive(k) &&
                (!bridge || cross_sign(ring.arm(static_cast<std::size_t>(after)).normal, ring.arm(k).normal) != 0)) {
                lost.push_back(ring.arm(k).contact);
            }
        }
        for (const int l : lost) {
            drop(l);
        }
    }

    const Packing& packing_;
    const std::vector<Contact>& contacts_;
    std::vector<Ring> rings_;
    std::vector<Hold> hold_;
    std::vector<unsigned char> carrying_;
    std::vector<std::size_t> waiting_;
    int now_ = 0;
    Peeling out_;
};

} // namespace

Peeling peel(const Packing& packing, const std::vector<Contact>& contacts) {
    return packing.dimension == plane && packing.bars.empty() ? Peeler(packing, contacts).run()
                                                              : peel_in_space(packing, contacts);
}

} // namespace isostat::crafted
