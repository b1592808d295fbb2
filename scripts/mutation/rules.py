"""Where a source can be mutated, from its syntax tree (libclang): each rule looks at one node and gives mutations."""
import re

import clang.cindex as clang
from clang.cindex import CursorKind as Kind, TypeKind

SWAPPED = {"<": ["<=", ">"], "<=": ["<", ">"], ">": [">=", "<"], ">=": [">", "<"], "==": ["!="], "!=": ["=="],
           "&&": ["||"], "||": ["&&"], "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["*"]}
ASSIGNED = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|=", "<<=": ">>=", ">>=": "<<="}
ARITHMETIC = {TypeKind.BOOL, TypeKind.CHAR_S, TypeKind.UCHAR, TypeKind.SCHAR, TypeKind.SHORT, TypeKind.USHORT, TypeKind.INT,
              TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG, TypeKind.FLOAT,
              TypeKind.DOUBLE}
FLOATING = {TypeKind.FLOAT, TypeKind.DOUBLE}


def is_eigen(node):
    return "Eigen::" in node.type.get_canonical().spelling


def is_arithmetic(node):
    return node.type.get_canonical().kind in ARITHMETIC


class Text:
    """The bytes of one file, and the text of a node in it."""

    def __init__(self, data):
        self.data = data

    def of(self, start, end):
        return self.data[start:end].decode()

    def node(self, node):
        return self.of(node.extent.start.offset, node.extent.end.offset)

    def between(self, left, right):
        """What stands between two nodes, without white space: the operator, when nothing else does."""
        return self.of(left.extent.end.offset, right.extent.start.offset).strip()


def operands(node):
    """(left, right) of a binary operator, built in or overloaded; None when this is no binary operator."""
    children = list(node.get_children())
    if node.kind == Kind.BINARY_OPERATOR and len(children) == 2:
        return children
    if node.kind == Kind.CALL_EXPR and node.spelling.startswith("operator") and len(children) == 3:
        return [children[0], children[2]]
    return None


def operators(node, text):
    """< becomes <= and >, + becomes -, && becomes ||, and so on."""
    sides = operands(node)
    if not sides:
        return
    operator = text.between(*sides)
    left, right = text.node(sides[0]), text.node(sides[1])
    for other in SWAPPED.get(operator, []):
        if is_arithmetic(node):
            yield "operator", f"{left} {other} {right}", "value"
        elif is_eigen(node) and operator in "+-":
            yield "operator", f"(({left}) {other} ({right})).eval()", "evaluated"


def assignments(node, text):
    """+= becomes -=, ++ becomes --."""
    if node.kind == Kind.COMPOUND_ASSIGNMENT_OPERATOR:
        left, right = list(node.get_children())
        operator = text.between(left, right)
        if operator in ASSIGNED:
            yield "assignment", f"{text.node(left)} {ASSIGNED[operator]} {text.node(right)}", "value"
    elif node.kind == Kind.UNARY_OPERATOR:
        whole = text.node(node)
        for operator, other in (("++", "--"), ("--", "++")):
            if whole.startswith(operator):
                yield "assignment", other + whole[2:], "value"
            elif whole.endswith(operator):
                yield "assignment", whole[:-2] + other, "value"


def signs(node, text):
    """-x becomes x, !x becomes x."""
    if node.kind == Kind.UNARY_OPERATOR and is_arithmetic(node):
        whole = text.node(node)
        if whole[:1] in ("-", "!") and not whole.startswith("--"):
            yield "sign", whole[1:], "value"


def literals(node, text):
    """0 becomes 1, other integers grow by one; 0.0 becomes 1.0, other decimals double; true becomes false."""
    whole = text.node(node)
    if node.kind == Kind.INTEGER_LITERAL and re.fullmatch(r"\d+", whole):
        yield "constant", str(int(whole) + 1), "value"
    elif node.kind == Kind.FLOATING_LITERAL and re.fullmatch(r"[\d.]+(e[-+]?\d+)?", whole):
        yield "constant", "1.0" if float(whole) == 0 else f"(2.0 * {whole})", "value"
    elif node.kind == Kind.CXX_BOOL_LITERAL_EXPR and whole in ("true", "false"):
        yield "constant", {"true": "false", "false": "true"}[whole], "value"


def conditions(node, text):
    """if (c) becomes if (true) and if (false)."""
    children = list(node.get_children())
    if node.kind == Kind.IF_STMT and children and children[0].kind.is_expression():
        yield "condition", "true", ("value", children[0])
        yield "condition", "false", ("value", children[0])


def extremes(node, text):
    """std::min becomes std::max and the other way round."""
    if node.kind != Kind.CALL_EXPR or node.spelling not in ("min", "max"):
        return
    found = re.match(r"std::(min|max)(?=[(<])", text.node(node))
    if found:
        other = {"min": "max", "max": "min"}[found[1]]
        yield "extreme", f"std::{other}{text.node(node)[found.end():]}", "value"


SYMMETRIC = re.compile(r"min|max|swap|hypot|_mm\d*_(add|mul|and|or|xor)_\w+")


def arguments(node, text):
    """f(a, b) becomes f(b, a), where both have the same type."""
    if node.kind != Kind.CALL_EXPR or node.spelling.startswith("operator") or not node.referenced:
        return
    if node.referenced.kind in (Kind.CONSTRUCTOR, Kind.CONVERSION_FUNCTION) or SYMMETRIC.fullmatch(node.spelling):
        return
    given = [a for a in node.get_arguments() if a]
    begin = node.extent.start.offset
    for a, b in zip(given, given[1:]):
        (a0, a1), (b0, b1) = [(x.extent.start.offset, x.extent.end.offset) for x in (a, b)]
        if a.type.get_canonical().spelling != b.type.get_canonical().spelling or a1 > b0 or text.node(a) == text.node(b):
            continue
        if text.of(a1, b0).strip() == ",":
            whole = text.node(node)
            yield ("arguments", whole[:a0 - begin] + text.of(b0, b1) + text.of(a1, b0) + text.of(a0, a1)
                   + whole[b1 - begin:], "value")


def statements(node, text):
    """A statement of a block (a call, an assignment, break, continue) is left out."""
    if node.kind != Kind.COMPOUND_STMT:
        return
    for child in node.get_children():
        plain = child.kind.is_expression() and not text.node(child).startswith(("throw ", "throw;"))
        if plain or child.kind in (Kind.BREAK_STMT, Kind.CONTINUE_STMT):
            yield "statement", "", ("statement", child)


RULES = (operators, assignments, signs, literals, conditions, extremes, arguments, statements)
