"""What Ulna says of tests and conformity: (en, de, zh), see `words`."""

from __future__ import annotations

TESTS: dict[str, tuple[str, str, str]] = {
    "test-method": (
        "Test, evaluated in the manner of {manner}",
        "Prüfung, ausgewertet in der Art von {manner}",
        "检验，按 {manner} 的方式评定",
    ),
    "test-method-text": (
        "Each value is computed as its description says. That the text of the standard was followed is not stated.",
        "Jeder Wert ist berechnet, wie seine Beschreibung sagt. Dass der Text der Norm befolgt wurde, wird nicht "
        "behauptet.",
        "各值按其说明计算。此处不声明遵循了该标准的条文。",
    ),
    "singles": ("{name}, each value", "{name}, jeder Wert", "{name}，各值"),
    "departures": ("Departures from the profile", "Abweichungen vom Profil", "与检验方案的偏离"),
    "budget": ("Uncertainty of the test value", "Unsicherheit des Prüfwerts", "检验值的不确定度"),
    "contributors": (
        "Contributors, standard uncertainties",
        "Beiträge, Standardunsicherheiten",
        "各分量的标准不确定度",
    ),
    "left-out": ("Not included: {what}", "Nicht enthalten: {what}", "未包括：{what}"),
    "conformity": ("Statement of conformity", "Konformitätsaussage", "符合性声明"),
    "rule": (
        "Decision rule, in the manner of ISO 14253-1: pass where |value| ≤ limit - g, fail where |value| > "
        "limit + g, else "
        "undecided; {guard}. u is of the test value, not of the arm.",
        "Entscheidungsregel in der Art von ISO 14253-1: bestanden bei |Wert| ≤ Grenze - g, nicht bestanden bei "
        "|Wert| > "
        "Grenze + g, sonst unentschieden; {guard}. u gehört zum Prüfwert, nicht zum Arm.",
        "判定规则，按 ISO 14253-1 的方式：|值| ≤ 限值 - g 为合格，|值| > 限值 + g 为不合格，否则未决；{guard}。"
        "u 为检验值的标准不确定度，"
        "而非测量臂的。",
    ),
    "guard-1.65u": ("g = 1.65 u (95 %)", "g = 1,65 u (95 %)", "g = 1.65 u（95 %）"),
    "guard-U": ("g = U = {k} u", "g = U = {k} u", "g = U = {k} u"),
    "guard-simple": ("g = 0, simple acceptance", "g = 0, einfache Annahme", "g = 0，简单接受"),
    "title-as-found": ("Test {profile}, as found", "Prüfung {profile}, wie vorgefunden", "检验 {profile}，调整前"),
    "title-as-left": ("Test {profile}, as left", "Prüfung {profile}, wie übergeben", "检验 {profile}，调整后"),
    "artefact-temperature": ("Temperature of the artefacts", "Temperatur der Normale", "标准器温度"),
    "limit": ("Limit of the magnitude", "Grenze des Betrags", "绝对值限值"),
    "guard": ("Guard band", "Schutzband", "保护带"),
    "says-pass": (
        "Conforms: the magnitude is below the limit by the guard band or more. {rule}",
        "Konform: Der Betrag liegt um mindestens das Schutzband unter der Grenze. {rule}",
        "符合：绝对值低于限值，且差值不小于保护带。{rule}",
    ),
    "says-fail": (
        "Does not conform: the magnitude is above the limit by more than the guard band. {rule}",
        "Nicht konform: Der Betrag liegt um mehr als das Schutzband über der Grenze. {rule}",
        "不符合：绝对值超出限值，且差值大于保护带。{rule}",
    ),
    "says-conditionalPass": (
        "Undecided: the magnitude is not above the limit, but nearer to it than the guard band. Neither "
        "conformity nor "
        "non-conformity is shown (conditional pass in the words of ILAC-G8:09/2019, 4.2.3). {rule}",
        "Unentschieden: Der Betrag liegt nicht über der Grenze, aber näher an ihr als das Schutzband. Weder "
        "Konformität "
        "noch Nichtkonformität ist nachgewiesen (conditional pass in den Worten von ILAC-G8:09/2019, 4.2.3). {rule}",
        "未决：绝对值未超出限值，但与限值之差小于保护带。既未证明符合，也未证明不符合（ILAC-G8:09/2019 第 "
        "4.2.3 条所称"
        " conditional pass）。{rule}",
    ),
    "says-conditionalFail": (
        "Undecided: the magnitude is above the limit, but not by more than the guard band. Neither conformity nor "
        "non-conformity is shown (conditional fail in the words of ILAC-G8:09/2019, 4.2.3). {rule}",
        "Unentschieden: Der Betrag liegt über der Grenze, aber nicht um mehr als das Schutzband. Weder "
        "Konformität noch "
        "Nichtkonformität ist nachgewiesen (conditional fail in den Worten von ILAC-G8:09/2019, 4.2.3). {rule}",
        "未决：绝对值超出限值，但差值不大于保护带。既未证明符合，也未证明不符合（ILAC-G8:09/2019 第 4.2.3 条所称"
        " conditional fail）。{rule}",
    ),
    "undecidable": (
        "Not decided: the rule needs an uncertainty of this value, and none is known. {rule}",
        "Nicht entschieden: Die Regel braucht eine Unsicherheit dieses Wertes, und es ist keine bekannt. {rule}",
        "未判定：该规则需要此值的不确定度，而其未知。{rule}",
    ),
    "no-limit": (
        "No limit is specified: nothing is said of conformity.",
        "Es ist keine Grenze vorgegeben: Zur Konformität wird nichts gesagt.",
        "未规定限值：不作符合性声明。",
    ),
    "whole-pass": (
        "{title}: all values with a limit conform. {rule}",
        "{title}: Alle Werte mit einer Grenze sind konform. {rule}",
        "{title}：所有有限值的值均符合。{rule}",
    ),
    "whole-fail": (
        "{title}: at least one value does not conform. {rule}",
        "{title}: Mindestens ein Wert ist nicht konform. {rule}",
        "{title}：至少一个值不符合。{rule}",
    ),
    "whole-conditionalPass": (
        "{title}: undecided; no value is above its limit, but not all are below it by the guard band. {rule}",
        "{title}: unentschieden; kein Wert liegt über seiner Grenze, aber nicht alle um das Schutzband "
        "darunter. {rule}",
        "{title}：未决；没有值超出限值，但并非所有值均以保护带之差低于限值。{rule}",
    ),
    "whole-conditionalFail": (
        "{title}: undecided; at least one value is above its limit, none by more than the guard band. {rule}",
        "{title}: unentschieden; mindestens ein Wert liegt über seiner Grenze, keiner um mehr als das "
        "Schutzband. {rule}",
        "{title}：未决；至少一个值超出限值，但均未超出保护带。{rule}",
    ),
    "whole-noPass": (
        "{title}: conformity is not shown; not every value with a limit could be decided. {rule}",
        "{title}: Konformität ist nicht nachgewiesen; nicht jeder Wert mit einer Grenze ließ sich entscheiden. {rule}",
        "{title}：未证明符合；并非每个有限值的量都能判定。{rule}",
    ),
}
