#pragma once

#include <memory>
#include <string>

// A formula of x and y, for heights of terrain.
namespace tread::scene
{

/// What a formula may be made of, for messages and documentation.
extern const char* const formula_language;

/// Why `text` is no formula, naming the token at fault; empty if it is one.
std::string formula_problem(const std::string& text);

/// Evaluates a formula. The same text gives the same numbers in every locale. Not to be shared by threads.
class FormulaEvaluator
{
public:
    /// InputError if the text is no formula.
    explicit FormulaEvaluator(const std::string& text);
    ~FormulaEvaluator();
    FormulaEvaluator(FormulaEvaluator&&) noexcept;
    FormulaEvaluator& operator=(FormulaEvaluator&&) noexcept;
    FormulaEvaluator(const FormulaEvaluator&)            = delete;
    FormulaEvaluator& operator=(const FormulaEvaluator&) = delete;

    /// May be NaN or infinite.
    double operator()(double x, double y);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tread::scene
