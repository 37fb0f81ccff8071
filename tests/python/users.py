"""What foreign programs are given, importable by their workers."""
import elastocheck

NUMBERS = ["points.tie_rod_inner.z", "points.tie_rod_outer.z"]
scene = None


def bump_steer(values):
    """Of the double wishbone at its design position, by the heights of two hardpoints."""
    global scene
    if scene is None:
        scene = elastocheck.new("double_wishbone")
    kc = elastocheck.kc(scene.vary(dict(zip(NUMBERS, values))), "series", branches="travel", steps=2)
    return float(kc["travel"]["bump_steer"][1])  # of -80, 0 and 80 mm


def toe_at_full_jounce(values):
    """Of the McPherson strut, likewise."""
    strut = elastocheck.new("mcpherson", settings=dict(zip(NUMBERS, values)))
    return float(strut.solve("series", "toe", branches="jounce", steps=1)["jounce"]["toe"][-1])
