#include "answers/genericity.hpp"

#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "io/files.hpp"

namespace isostat::cli {

int genericity(const GenericityArguments& a) {
    check_output(a.csv, answers::genericity_head, {a.file});
    answers::GenericityAnswer answer{a.file, answers::read_original(a.file), a.options,
                                     static_cast<std::size_t>(a.lists)};
    answers::Answer told = answers::head_of(answer);
    const auto show = [&a](const std::string& text) { say_lines(a.common.json ? "" : text); };
    show(told.text);
    std::string csv = answers::genericity_head;
    std::vector<crafted::Genericity> all;
    bool every = true;
    for (const double size : a.sizes) {
        answer.options.size = size;
        all.push_back(crafted::genericity(answer.original.packing, answer.original.contacts, answer.options));
        const crafted::Genericity& result = all.back();
        every = every && result.proved == a.options.samples;
        csv += answers::csv_rows(result, size);
        answers::Answer row = answers::row_of(answer, result, size);
        show(row.text);
        told.json["sizes"].push_back(std::move(row.json));
    }
    if (!a.csv.empty()) {
        write_output(a.csv, csv, answers::genericity_head);
    }
    told.text = answers::closing_text(answer, all, a.sizes);
    print(std::move(told), a.common, "isostat-genericity 1");
    return every ? done : undecided;
}

} // namespace isostat::cli
