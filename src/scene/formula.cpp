#include "scene/formula.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <muParser.h>

#include "base/errors.hpp"

namespace tread::scene
{
namespace
{

/// Other syntax that the library accepts (assignments, comparisons, strings) has no meaning as a height.
constexpr const char* formula_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.,+-*/^() \t\n";

double smallest(const double* values, int count) { return *std::min_element(values, values + count); }
double largest(const double* values, int count) { return *std::max_element(values, values + count); }

/// Defines functions as in `formula_language`, with the meaning of <cmath>, instead of the library's own.
void define_language(mu::Parser& parser)
{
    using Unary = double (*)(double);
    parser.ClearFun();
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("sin", static_cast<Unary>(std::sin));
    parser.DefineFun("cos", static_cast<Unary>(std::cos));
    parser.DefineFun("tan", static_cast<Unary>(std::tan));
    parser.DefineFun("sqrt", static_cast<Unary>(std::sqrt));
    parser.DefineFun("exp", static_cast<Unary>(std::exp));
    parser.DefineFun("log", static_cast<Unary>(std::log));
    parser.DefineFun("abs", static_cast<Unary>(std::fabs));
    parser.DefineFun("min", smallest);
    parser.DefineFun("max", largest);
}

} // namespace

const char* const formula_language =
    "formula of x and y (m) with + - * / ^ ( ) sin cos tan sqrt exp log abs min max pi";

struct FormulaEvaluator::Parts
{
    double     x = 0;
    double     y = 0;
    mu::Parser parser;
};

FormulaEvaluator::FormulaEvaluator(const std::string& text)
    : parts_(std::make_unique<Parts>())
{
    const auto strange = text.find_first_not_of(formula_letters);
    if (strange != std::string::npos)
    {
        throw InputError(fmt::format("\"{}\" has no meaning at character {}", text[strange], strange + 1));
    }
    try
    {
        define_language(parts_->parser);
        parts_->parser.DefineVar("x", &parts_->x);
        parts_->parser.DefineVar("y", &parts_->y);
        parts_->parser.SetExpr(text);
        parts_->parser.Eval();
        if (parts_->parser.GetNumResults() != 1) { throw InputError("a comma outside min() and max()"); }
    }
    catch (const mu::Parser::exception_type& error)
    {
        const std::string& token = error.GetToken();
        throw InputError(token.empty() ? fmt::format("not a formula: {}", error.GetMsg())
                                       : fmt::format("not a formula at \"{}\": {}", token, error.GetMsg()));
    }
}

FormulaEvaluator::~FormulaEvaluator()                                      = default;
FormulaEvaluator::FormulaEvaluator(FormulaEvaluator&&) noexcept            = default;
FormulaEvaluator& FormulaEvaluator::operator=(FormulaEvaluator&&) noexcept = default;

double FormulaEvaluator::operator()(double x, double y)
{
    parts_->x = x;
    parts_->y = y;
    return parts_->parser.Eval();
}

std::string formula_problem(const std::string& text)
{
    try
    {
        FormulaEvaluator{text};
    }
    catch (const InputError& error)
    {
        return error.what();
    }
    return {};
}

} // namespace tread::scene
