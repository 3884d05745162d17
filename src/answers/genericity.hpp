#pragma once
/// \file
/// The output of `genericity`.

#include "answers/answer.hpp"
#include "crafted/genericity.hpp"

#include <isostat/packing/packing.hpp>
#include <isostat/rigidity/counting.hpp>

#include <span>
#include <string>
#include <vector>

namespace isostat::answers {

/// The unperturbed packing: its contacts, and bounds of h and k.
struct GenericityOriginal {
    Packing packing;
    std::vector<Contact> contacts;
    int hyperstaticity = 0;
    int mechanisms = 0;
    Counting with_radii;
    Verdict exact = Verdict::undecided;
    std::string title;
};

/// Reads a crafted packing, a state or a vertex text. Throws `Error(bad_input)`.
GenericityOriginal read_original(const std::string& file);

struct GenericityAnswer {
    std::string file; ///< its name
    GenericityOriginal original;
    crafted::GenericityOptions options;
    std::size_t lists = 0; ///< largest number of lists shown for each size
};

/// What was asked and the unperturbed packing, with an empty list of `sizes`; the answer for one size; and, as text
/// alone, the most frequent lists and the failures of all sizes.
Answer head_of(const GenericityAnswer& answer);
Answer row_of(const GenericityAnswer& answer, const crafted::Genericity& result, double size);
std::string closing_text(const GenericityAnswer& answer, const std::vector<crafted::Genericity>& results,
                         std::span<const double> sizes);

inline constexpr const char* genericity_head =
    "size,seed,result,h,k,carrying,rattlers,min_force,min_gap,sigma_min,within_original\n";
std::string csv_rows(const crafted::Genericity& result, double size);

} // namespace isostat::answers
