#include "contact/separation.hpp"
#include "core/refuse.hpp"
#include "crafted/able.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace isostat::crafted {

namespace {

/// A direction from a grain, not normalised, to the other centre or to a wall. In the plane the third component is the
/// torque of a force along it about the first member of the body, which is 0 of a single disk.
struct Direction {
    int contact;
    bool reversed; ///< from the second grain of the pair
    int about;     ///< the torque is about its centre: the first member of the body

    template <class Number>
    [[nodiscard]] PerAxis<Number> in(const Packing& packing, const std::vector<Contact>& all) const {
        const Contact& c = all[static_cast<std::size_t>(contact)];
        PerAxis<Number> d = c.of_disks() ? PerAxis<Number>{} : wall_normal<Number>(c);
        if (c.of_disks()) {
            const auto minus = [](const Number& a, const Number& b) -> Number { return a - b; };
            d = Separation(c, packing.layout()).of_disks([&](std::size_t k) { return Number(packing.q[k]); }, minus);
            for (Number& component : d) {
                component = reversed ? Number(-component) : component;
            }
        }
        if (const int at = reversed ? c.j : c.i; packing.dimension == plane && at != about) {
            const auto arm = [&](int axis) -> Number {
                return Number(packing.coordinate(DiskId(static_cast<std::size_t>(at)), axis)) -
                       Number(packing.coordinate(DiskId(static_cast<std::size_t>(about)), axis));
            };
            d[2] = Number(arm(0) * d[1]) - Number(arm(1) * d[0]);
        }
        return d;
    }
};

/// Signs of expressions in directions, by intervals and then by rationals.
class Signs {
  public:
    Signs(const Packing& packing, const std::vector<Contact>& contacts) : packing_(packing), contacts_(contacts) {}

    /// Sign of `expression(directions)`, in the first arithmetic that decides it.
    template <std::size_t Count, class Expression>
    [[nodiscard]] int of(const std::array<Direction, Count>& directions, Expression expression) const {
        using Interval = CGAL::Interval_nt<false>;
        {
            const Interval::Protector upward;
            if (const auto sign = CGAL::sign(value<Interval>(directions, expression)); sign.is_certain()) {
                return sign.make_certain();
            }
        }
        return CGAL::sign(value<CGAL::Exact_rational>(directions, expression));
    }

  private:
    template <class Number, std::size_t Count, class Expression>
    [[nodiscard]] Number value(const std::array<Direction, Count>& directions, Expression expression) const {
        std::array<PerAxis<Number>, Count> in;
        for (std::size_t k = 0; k < Count; ++k) {
            in[k] = directions[k].template in<Number>(packing_, contacts_);
        }
        return expression(in);
    }
    const Packing& packing_;
    const std::vector<Contact>& contacts_;
};

class Peeler {
  public:
    Peeler(const Packing& packing, const std::vector<Contact>& contacts)
        : packing_(packing), contacts_(contacts), bodies_(packing), signs_(packing, contacts),
          flat_(packing.dimension == plane && packing.bars.empty()), around_(packing.radius.size()),
          waiting_(packing.radius.size()), now_(static_cast<int>(contacts.size())) {
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (flat_ && contacts[l].of_disks() && contacts[l].i == contacts[l].j) {
                refuse(ErrorKind::bad_input,
                       "disk {} is near its own image: expected a cell that is larger than the largest disk and the "
                       "threshold",
                       contacts[l].i);
            }
            const Direction direction{static_cast<int>(l), false, bodies_.of(contacts[l].i)};
            if (signs_.of<1>({direction}, [](const auto& x) { return dot(x[0], x[0]); }) == 0) {
                refuse(to_string(contacts[l], packing.dimension),
                       "the two {}s have the same centre: expected different ones", grain_word(packing.dimension));
            }
            around_[static_cast<std::size_t>(direction.about)].push_back(direction);
            if (contacts[l].of_disks()) {
                const int other = bodies_.of(contacts[l].j);
                around_[static_cast<std::size_t>(other)].push_back({static_cast<int>(l), true, other});
            }
        }
        out_.contact_from.assign(contacts.size(), 0);
        out_.disk_from.assign(around_.size(), 0);
        std::iota(waiting_.begin(), waiting_.end(), std::size_t{0});
    }

    Peeling run() {
        settle();
        for (int l = now_; l-- > 0;) {
            now_ = l;
            drop(l);
            settle();
        }
        for (std::size_t i = 0; i < around_.size(); ++i) {
            out_.disk_from[i] = out_.disk_from[static_cast<std::size_t>(bodies_.of(static_cast<int>(i)))];
        }
        return std::move(out_);
    }

  private:
    void take(int grain, int contact) {
        const auto place = static_cast<std::size_t>(bodies_.of(grain));
        std::erase_if(around_[place], [contact](const Direction& d) { return d.contact == contact; });
        waiting_.push_back(place);
    }
    void drop(int l) {
        int& from = out_.contact_from[static_cast<std::size_t>(l)];
        if (from != 0) {
            return;
        }
        from = now_ + 1;
        const Contact& c = contacts_[static_cast<std::size_t>(l)];
        take(c.i, l);
        if (c.of_disks()) {
            take(c.j, l);
        }
    }
    void settle() {
        while (!waiting_.empty()) {
            const std::size_t grain = waiting_.back();
            waiting_.pop_back();
            if (!packing_.is_fixed(DiskId(grain)) && out_.disk_from[grain] == 0) {
                judge(grain);
            }
        }
    }
    void judge(std::size_t grain) {
        const std::vector<Direction> before = around_[grain];
        const std::vector<Direction> after = able(before, signs_, flat_);
        for (const Direction& d : before) {
            const bool stays =
                std::ranges::any_of(after, [&](const Direction& other) { return other.contact == d.contact; });
            if (!stays) {
                drop(d.contact);
            }
        }
        out_.disk_from[grain] = after.empty() ? now_ + 1 : 0;
    }

    const Packing& packing_;
    const std::vector<Contact>& contacts_;
    Bodies bodies_;
    Signs signs_;
    bool flat_;                                  ///< single disks: two components are enough
    std::vector<std::vector<Direction>> around_; ///< the directions of each grain, of a body at its first member
    std::vector<std::size_t> waiting_;
    int now_; ///< number of contacts: what fails from here on needs more
    Peeling out_;
};

} // namespace

Peeling peel(const Packing& packing, const std::vector<Contact>& contacts) {
    return Peeler(packing, contacts).run();
}

} // namespace isostat::crafted
