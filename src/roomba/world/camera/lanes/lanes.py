"""Lanes: sixteen numbers that compiled kernels work on at once, for as many pixels.

Numba has no such type, and LLVM does not see that a loop over pixels that looks up texels and
colours can be done in wide instructions: pixel by pixel, look-ups take two to four times as long.
The vectors are LLVM's own, so that any processor does with them what it can.

Lanes are ``REAL``, float32; ``WHOLE``, int32 that wraps around; or ``CHOICE``, yes or no. Kernels
use Python's operators on them, and the functions below; a number among the operands counts for all
lanes. Lanes can be a kernel's variables, arguments and results, but not values of an array: see
:mod:`roomba.world.camera.lanes.lane_memory` for these.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, Final

import llvmlite.ir as ir
from numba import types
from numba.core import cgutils
from numba.extending import (
    intrinsic,
    lower_builtin,
    models,
    register_model,
    type_callable,
)

LANES: Final = 16
"""The lanes of the widest instructions; other processors take two or four steps."""
_FLAGS: Final = ("arcp", "contract", "nsz")


intrinsic_of_llvm: Final[Any] = cgutils.get_or_insert_function
_type_by: Final[Any] = type_callable
_lower_by: Final[Any] = lower_builtin


class LaneType(types.Type):
    """The type of lanes, for numba."""

    def __init__(self, name: str, single: ir.Type) -> None:
        super().__init__(name)
        self.single = single
        self.vector = ir.VectorType(single, LANES)


REAL: Final = LaneType("RealLanes", ir.FloatType())
WHOLE: Final = LaneType("WholeLanes", ir.IntType(32))
CHOICE: Final = LaneType("ChoiceLanes", ir.IntType(1))


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: LaneType) -> None:
        super().__init__(manager, kind, kind.vector)  # type: ignore[no-untyped-call]


def lanes_of(context: Any, builder: Any, kind: LaneType, given: types.Type, value: Any) -> Any:
    """Return a value as lanes of a kind; a number in all of them."""
    if isinstance(given, LaneType):
        return value
    number = types.int32 if kind == WHOLE else types.float32
    return spread(builder, context.cast(builder, value, given, number), kind.vector)


def spread(builder: Any, single: Any, vector: ir.VectorType) -> Any:
    """Return a vector with the same in all lanes."""
    undefined = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(undefined, single, ir.Constant(ir.IntType(32), 0))
    same = ir.Constant(ir.VectorType(ir.IntType(32), vector.count), [0] * vector.count)
    return builder.shuffle_vector(first, undefined, same)


Build = Callable[[Any, Any, Any], Any]
"""Of a builder and two vectors."""


def _define(function: Any, builds: dict[LaneType, Build], result: LaneType | None = None) -> None:
    """Let kernels use one of Python's operators on lanes, or on lanes and a number.

    The result is of the lanes' own kind if ``result`` is None.
    """

    def kind_of(left: types.Type, right: types.Type) -> LaneType | None:
        kind = left if isinstance(left, LaneType) else right
        if kind not in builds or not all(
            given == kind or isinstance(given, types.Number) for given in (left, right)
        ):
            return None
        return kind

    def typer(context: Any) -> Any:
        def typed(left: types.Type, right: types.Type) -> LaneType | None:
            kind = kind_of(left, right)
            return kind and (result or kind)

        return typed

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = kind_of(*signature.args)
        assert kind is not None
        left, right = (
            lanes_of(context, builder, kind, given, value)
            for given, value in zip(signature.args, arguments, strict=True)
        )
        return builds[kind](builder, left, right)

    _type_by(function)(typer)
    for pair in ((LaneType, LaneType), (LaneType, types.Number), (types.Number, LaneType)):
        _lower_by(function, *pair)(lower)


def _whole(name: str) -> Build:
    """Return what emits an instruction by its name in LLVM."""
    return lambda builder, left, right: getattr(builder, name)(left, right)


def _real(name: str) -> Build:
    return lambda builder, left, right: getattr(builder, name)(left, right, flags=_FLAGS)


def _compare(sign: str) -> dict[LaneType, Build]:
    return {
        WHOLE: lambda builder, left, right: builder.icmp_signed(sign, left, right),
        REAL: lambda builder, left, right: builder.fcmp_ordered(sign, left, right),
    }


_define(operator.add, {WHOLE: _whole("add"), REAL: _real("fadd")})
_define(operator.sub, {WHOLE: _whole("sub"), REAL: _real("fsub")})
_define(operator.mul, {WHOLE: _whole("mul"), REAL: _real("fmul")})
_define(operator.truediv, {REAL: _real("fdiv")})
_define(operator.and_, {WHOLE: _whole("and_"), CHOICE: _whole("and_")})
_define(operator.or_, {WHOLE: _whole("or_")})
_define(operator.lshift, {WHOLE: _whole("shl")})
_define(operator.rshift, {WHOLE: _whole("ashr")})
_define(operator.lt, _compare("<"), CHOICE)
_define(operator.le, _compare("<="), CHOICE)
_define(operator.gt, _compare(">"), CHOICE)
_define(operator.ge, _compare(">="), CHOICE)


def _steps(typing: Any) -> Any:
    """0, 1, 2 and so on."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return ir.Constant(WHOLE.vector, list(range(LANES)))

    return WHOLE(), generate


def _in_all(kind: LaneType) -> Any:
    """A number in all lanes."""

    def typed(typing: Any, number: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return lanes_of(context, builder, kind, signature.args[0], arguments[0])

        return kind(number), generate

    return typed


def _floored(typing: Any, real: Any) -> Any:
    """The whole numbers at or below; any number for what does not fit into 32 bits."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        function = intrinsic_of_llvm(
            builder.module, ir.FunctionType(REAL.vector, [REAL.vector]), f"llvm.floor.v{LANES}f32"
        )
        return builder.fptosi(builder.call(function, arguments), WHOLE.vector)

    return WHOLE(REAL), generate


def _cut(typing: Any, real: Any) -> Any:
    """The whole numbers next towards zero; any number for what does not fit into 32 bits."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fptosi(arguments[0], WHOLE.vector)

    return WHOLE(REAL), generate


def _as_real(typing: Any, whole: Any) -> Any:
    """Whole numbers as real ones."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.sitofp(arguments[0], REAL.vector)

    return REAL(WHOLE), generate


def _where(typing: Any, choice: Any, one: Any, other: Any) -> Any:
    """The one where chosen, else the other; a number counts for all lanes."""
    kind = one if isinstance(one, LaneType) else other

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        one, other = (
            lanes_of(context, builder, kind, given, value)
            for given, value in zip(signature.args[1:], arguments[1:], strict=True)
        )
        return builder.select(arguments[0], one, other)

    return kind(choice, one, other), generate


def _within(typing: Any, whole: Any, low: Any, high: Any) -> Any:
    """Whole numbers, or ``low`` or ``high`` where they are less or more than these."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        whole, low, high = (
            lanes_of(context, builder, WHOLE, given, value)
            for given, value in zip(signature.args, arguments, strict=True)
        )
        whole = builder.select(builder.icmp_signed("<", whole, high), whole, high)
        return builder.select(builder.icmp_signed(">", whole, low), whole, low)

    return WHOLE(whole, low, high), generate


def _any_of(typing: Any, choice: Any) -> Any:
    """Whether any lane is chosen."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        bits = builder.bitcast(arguments[0], ir.IntType(LANES))
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    return types.boolean(choice), generate


steps: Any = intrinsic(_steps)
all_real: Any = intrinsic(_in_all(REAL))
all_whole: Any = intrinsic(_in_all(WHOLE))
floored: Any = intrinsic(_floored)
cut: Any = intrinsic(_cut)
as_real: Any = intrinsic(_as_real)
where: Any = intrinsic(_where)
within: Any = intrinsic(_within)
any_of: Any = intrinsic(_any_of)
