"""Lanes from and to arrays: runs of values, look-ups in tables, turned squares, packed pixels.

See :mod:`roomba.world.camera.lanes.lanes`. Places count an array's values from its first, in any
shape; nothing checks that they, and all lanes from there on, are within it. Processors are assumed
to be little-endian.
"""

from __future__ import annotations

from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.extending import intrinsic

from roomba.world.camera.lanes.lanes import (
    LANES,
    REAL,
    WHOLE,
    LaneType,
    intrinsic_of_llvm,
    lanes_of,
    spread,
)

_WORD = ir.IntType(32)


def _kind_in(array: Any) -> LaneType:
    return REAL if isinstance(array.dtype, types.Float) else WHOLE


def _array(context: Any, builder: Any, signature: Any, arguments: Any, index: int) -> Any:
    return context.make_array(signature.args[index])(context, builder, arguments[index])


def _place(
    context: Any, builder: Any, signature: Any, arguments: Any, array: int, place: int, vector: Any
) -> Any:
    """Return a pointer to lanes in an array."""
    data = _array(context, builder, signature, arguments, array).data
    offset = context.cast(builder, arguments[place], signature.args[place], types.intp)
    return builder.bitcast(builder.gep(data, [offset]), vector.as_pointer())


def _load(typing: Any, array: Any, place: Any) -> Any:
    """LANES values from a place on."""
    kind = _kind_in(array)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        at = _place(context, builder, signature, arguments, 0, 1, kind.vector)
        return builder.load(at, align=4)

    return kind(array, place), generate


def _store(typing: Any, array: Any, place: Any, values: Any) -> Any:
    """Write lanes from a place on."""
    kind = _kind_in(array)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        at = _place(context, builder, signature, arguments, 0, 1, kind.vector)
        values = lanes_of(context, builder, kind, signature.args[2], arguments[2])
        builder.store(values, at, align=4)
        return context.get_dummy_value()

    return types.void(array, place, values), generate


def _gathered(builder: Any, data: Any, offsets: Any, align: int, kind: LaneType) -> Any:
    """Return the values of a kind that begin so many elements past a pointer."""
    pointers = ir.VectorType(ir.PointerType(), LANES)
    element = data.type.pointee
    at = builder.gep(spread(builder, data, pointers), [offsets], source_etype=element)
    choice = ir.VectorType(ir.IntType(1), LANES)
    letter = "f" if kind is REAL else "i"
    gather = intrinsic_of_llvm(
        builder.module,
        ir.FunctionType(kind.vector, [pointers, _WORD, choice, kind.vector]),
        f"llvm.masked.gather.v{LANES}{letter}32.v{LANES}p0",
    )
    # In all lanes: what can leave some out is slow on processors without such an instruction.
    everywhere = ir.Constant(choice, [1] * LANES)
    undefined = ir.Constant(kind.vector, ir.Undefined)
    return builder.call(gather, [at, ir.Constant(_WORD, align), everywhere, undefined])


def _look_up(typing: Any, table: Any, places: Any) -> Any:
    """The values of a table at these places; it is of four bytes or more."""
    kind = _kind_in(table)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = _array(context, builder, signature, arguments, 0)
        bits = table.dtype.bitwidth
        if bits == 32:
            return _gathered(builder, array.data, arguments[1], 4, kind)
        # Processors look up words only: the one that begins there, or the table's last.
        per_word = 32 // bits
        size = builder.sub(array.nitems, ir.Constant(array.nitems.type, per_word))
        last = spread(builder, builder.trunc(size, _WORD), WHOLE.vector)
        places = arguments[1]
        low = builder.select(builder.icmp_signed("<", places, last), places, last)
        words = _gathered(builder, array.data, low, bits // 8, WHOLE)
        past = builder.mul(builder.sub(places, low), ir.Constant(WHOLE.vector, [bits] * LANES))
        mask = ir.Constant(WHOLE.vector, [(1 << bits) - 1] * LANES)
        return builder.and_(builder.lshr(words, past), mask)

    return kind(table, places), generate


def _turn(
    typing: Any, source: Any, begin: Any, step: Any, target: Any, to: Any, across: Any
) -> Any:
    """Copy a square of LANES x LANES values of four bytes, with its rows as columns.

    Its rows begin at ``begin`` and every ``step`` values from there; the copy's at ``to`` and every
    ``across``.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        def rows(array: int, place: int, width: int) -> list[Any]:
            data = _array(context, builder, signature, arguments, array).data
            offset, step = (
                context.cast(builder, arguments[i], signature.args[i], types.intp)
                for i in (place, width)
            )
            found = []
            for _ in range(LANES):
                at = builder.gep(data, [offset])
                found.append(builder.bitcast(at, WHOLE.vector.as_pointer()))
                offset = builder.add(offset, step)
            return found

        half = LANES // 2
        halves = []
        for low in (0, half):
            zipped = [i + side for i in range(low, low + half) for side in (0, LANES)]
            halves.append(ir.Constant(WHOLE.vector, zipped))
        square = [builder.load(row, align=4) for row in rows(0, 1, 2)]
        # Like shuffling cards: after four times, neighbours in a row are neighbours in a column.
        for _ in range(4):
            square = [
                builder.shuffle_vector(square[i], square[i + half], zipped)
                for i in range(half)
                for zipped in halves
            ]
        for row, at in zip(square, rows(3, 4, 5), strict=True):
            builder.store(row, at, align=4)
        return context.get_dummy_value()

    return types.void(source, begin, step, target, to, across), generate


def _store_pixels(typing: Any, array: Any, place: Any, colours: Any) -> Any:
    """Write colours 0x00BBGGRR as bytes red, green, blue from a place on."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        count = 3 * LANES
        byte = ir.IntType(8)
        data = builder.bitcast(arguments[2], ir.VectorType(byte, 4 * LANES))
        kept = [4 * (i // 3) + i % 3 for i in range(count)]
        chosen = ir.Constant(ir.VectorType(_WORD, count), kept)
        packed = builder.shuffle_vector(data, ir.Constant(data.type, ir.Undefined), chosen)
        at = _place(context, builder, signature, arguments, 0, 1, ir.VectorType(byte, count))
        builder.store(packed, at, align=1)
        return context.get_dummy_value()

    return types.void(array, place, colours), generate


def _fetch(typing: Any, array: Any, place: Any) -> Any:
    """Begin to bring a place into the nearest cache, to be written soon; any place will do."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        at = _place(context, builder, signature, arguments, 0, 1, ir.IntType(8))
        function = intrinsic_of_llvm(
            builder.module,
            ir.FunctionType(ir.VoidType(), [ir.PointerType(), _WORD, _WORD, _WORD]),
            "llvm.prefetch.p0",
        )
        to_write, nearest, of_data = _WORD(1), _WORD(3), _WORD(1)
        builder.call(function, [at, to_write, nearest, of_data])
        return context.get_dummy_value()

    return types.void(array, place), generate


load: Any = intrinsic(_load)
fetch: Any = intrinsic(_fetch)
store: Any = intrinsic(_store)
look_up: Any = intrinsic(_look_up)
turn: Any = intrinsic(_turn)
store_pixels: Any = intrinsic(_store_pixels)
