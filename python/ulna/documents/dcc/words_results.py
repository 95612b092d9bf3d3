"""What Ulna says of results, methods and conditions: (en, de, zh), see `words`."""

from __future__ import annotations

RESULTS: dict[str, tuple[str, str, str]] = {
    "calibration": ("Kinematic calibration", "Kinematische Kalibrierung", "运动学校准"),
    "method": (
        "Kinematic calibration by least squares",
        "Kinematische Kalibrierung durch Ausgleichung",
        "最小二乘运动学校准",
    ),
    "method-text": (
        "Encoder readings taken at artefacts were fitted by weighted least squares ({search}). The model: "
        "turn = sign · encoder - theta0 for each joint, links after Denavit and Hartenberg, after Hayati "
        "where a label "
        "ends in beta{effects}.",
        "Ablesungen der Winkelgeber an Normalen wurden durch gewichtete Ausgleichung angepasst ({search}). "
        "Das Modell: "
        "Drehung = sign · Geber - theta0 für jedes Gelenk, Glieder nach Denavit und Hartenberg, nach Hayati, wo ein "
        "Name auf beta endet{effects}.",
        "对在标准器上采集的编码器读数进行加权最小二乘拟合（{search}）。模型：各关节转角 = sign · 编码器 - "
        "theta0，连杆按 "
        "Denavit–Hartenberg 约定，名称以 beta 结尾者按 Hayati 约定{effects}。",
    ),
    "effects": (
        "; beyond geometry: {extras}",
        "; über die Geometrie hinaus: {extras}",
        "；几何以外：{extras}",
    ),
    "temperature": ("Temperature", "Temperatur", "温度"),
    "temperature-low": ("Lowest temperature", "Niedrigste Temperatur", "最低温度"),
    "temperature-high": ("Highest temperature", "Höchste Temperatur", "最高温度"),
    "humidity": ("Relative humidity", "Relative Luftfeuchte", "相对湿度"),
    "humidity-low": ("Lowest relative humidity", "Niedrigste relative Luftfeuchte", "最低相对湿度"),
    "humidity-high": ("Highest relative humidity", "Höchste relative Luftfeuchte", "最高相对湿度"),
    "humidity-missing": (
        "The laboratory has not stated the humidity.",
        "Das Laboratorium hat die Luftfeuchte nicht angegeben.",
        "实验室未给出湿度。",
    ),
    "parameters": ("Parameters of the arm", "Parameter des Arms", "测量臂参数"),
    "parameters-text": (
        "Lengths in mm, angles in rad. Labels: joint.NUMBER.KIND from the base, probe.NAME.AXIS for the tip in the "
        "last frame, artefact.NAME.KIND for what was fitted of an artefact. A blank within a label is written %20, a "
        "percent sign %25.",
        "Längen in mm, Winkel in rad. Namen: joint.NUMMER.ART von der Basis an, probe.NAME.ACHSE für die "
        "Tasterspitze im "
        "letzten Koordinatensystem, artefact.NAME.ART für das, was von einem Normal angepasst wurde. Ein "
        "Leerzeichen im "
        "Namen steht als %20, ein Prozentzeichen als %25.",
        "长度单位 mm，角度单位 rad。标签：joint.序号.种类（自基座起）、probe.名称.坐标轴（末端坐标系中的测头端点）、"
        "artefact.名称.种类（对标准器拟合的量）。标签中的空格写作 %20，百分号写作 %25。",
    ),
    "fitted": ("Fitted parameters", "Ausgeglichene Parameter", "拟合参数"),
    "start": ("Their values before the calibration", "Ihre Werte vor der Kalibrierung", "其校准前的数值"),
    "unsure-values": (
        "Fitted parameters without uncertainty",
        "Ausgeglichene Parameter ohne Unsicherheit",
        "无不确定度的拟合参数",
    ),
    "held-values": ("Held parameters", "Festgehaltene Parameter", "固定参数"),
    "lost-values": ("Parameters that are not determined", "Nicht bestimmte Parameter", "未能确定的参数"),
    "given": (
        "Taken as given: signs of the encoders, balls, masses",
        "Als gegeben genommen: Vorzeichen der Winkelgeber, Tastkugeln, Massen",
        "视为已知：编码器符号、测球、质量",
    ),
    "fit": ("Fit", "Ausgleichung", "拟合"),
    "readings": ("Readings", "Ablesungen", "读数个数"),
    "freedom": ("Degrees of freedom", "Freiheitsgrade", "自由度"),
    "rms-before": (
        "Root mean square of the residuals before",
        "Quadratisches Mittel der Restabweichungen vorher",
        "校准前残差均方根",
    ),
    "rms-after": (
        "Root mean square of the residuals after",
        "Quadratisches Mittel der Restabweichungen nachher",
        "校准后残差均方根",
    ),
    "chi2": (
        "Chi-squared per degree of freedom; 1 where the stated noise is right",
        "Chi-Quadrat je Freiheitsgrad; 1, wo das angegebene Rauschen stimmt",
        "每自由度的卡方；噪声给定正确时为 1",
    ),
    "figures": ("Figures from the readings", "Kennzahlen aus den Ablesungen", "由读数得到的指标"),
    "figures-text": (
        "Computed from the fitted readings themselves, in mm: descriptive, without uncertainty, and no test "
        "on readings "
        "that were kept apart.",
        "Aus den ausgeglichenen Ablesungen selbst berechnet, in mm: beschreibend, ohne Unsicherheit, und "
        "keine Prüfung "
        "an zurückbehaltenen Ablesungen.",
        "由参与拟合的读数本身计算，单位 mm：仅为描述性统计，不带不确定度，也不是对保留读数的检验。",
    ),
    "before": ("Before the calibration", "Vor der Kalibrierung", "校准前"),
    "after": ("After the calibration", "Nach der Kalibrierung", "校准后"),
    "outliers": ("Readings far off", "Auffällige Ablesungen", "离群读数"),
    "no-outliers": (
        "No reading is farther off than one normal reading in ten thousand.",
        "Keine Ablesung weicht weiter ab als eine von zehntausend normalverteilten.",
        "没有读数偏离超过正态分布的万分之一界限。",
    ),
    "outlier": (
        "{file}, row {row}: artefact {artefact}, placement {placement}, {norm} mm, {times} times the scatter",
        "{file}, Zeile {row}: Normal {artefact}, Aufstellung {placement}, {norm} mm, {times}-fache Streuung",
        "{file}，第 {row} 行：标准器 {artefact}，位置 {placement}，{norm} mm，为离散度的 {times} 倍",
    ),
    "outliers-kept": (
        "All readings were used; those named here lie farther off than one normal reading in ten thousand.",
        "Alle Ablesungen wurden verwendet; die genannten weichen weiter ab als eine von zehntausend normalverteilten.",
        "全部读数均已采用；此处列出的读数偏离超过正态分布的万分之一界限。",
    ),
    "inputs": ("Input files", "Eingabedateien", "输入文件"),
}
