"""Messages of the robot as the schemas want them: state, visualization and factsheet (6.10, 6.13, 6.15)."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from robot_control.fleet.v2.capability import ActionKind
from robot_control.fleet.v2.messages import LIMITS, MAX_BYTES, MAX_ID, Error, Message
from robot_control.fleet.v2.order import Node
from robot_control.fleet.v2.vehicle import ActionState, Vehicle
from robot_control.robot.pose import turned

STATE_PERIOD = 30.0
"""s between two states at the latest (6.10)"""
PLACE = ("x", "y", "theta", "mapId")
"""what the schema knows of a nodePosition in a nodeState"""
PLACE_OPTIONS = ("theta", "allowedDeviationXY", "allowedDeviationTheta")
EDGE_OPTIONS = (
    *("maxSpeed", "maxHeight", "orientation", "orientationType", "rotationAllowed", "maxRotationSpeed", "trajectory"),
)
OPTIONAL = (
    *("order.nodes.nodePosition", *(f"order.nodes.nodePosition.{name}" for name in PLACE_OPTIONS)),
    *(f"order.edges.{name}" for name in EDGE_OPTIONS),
)


@dataclass(frozen=True)
class Facts:
    """The measured values of the robot."""

    x: float = 0.0  # m, on the map
    y: float = 0.0
    theta: float = 0.0  # rad
    map_id: str = ""  # empty: the position is not initialized
    deviation: float | None = None  # m, by the covariance
    linear: float = 0.0  # m/s
    angular: float = 0.0  # rad/s
    battery_charge: float | None = None  # %
    battery_voltage: float | None = None  # V
    charging: bool = False
    mode: str = "AUTOMATIC"  # operatingMode
    stopped: bool = False  # a stop is latched, which a reset at the robot ends
    may_drive: bool = True  # the safety monitor permits it
    permit: tuple[int, int] = (0, 0)  # that of the monitor: each stop and each start begin another one
    silent: bool = False  # odometry or safety_status does not come
    held_by: str = ""  # why the present path is paused at the robot
    blocked_by: str = ""  # why the collision guard leaves the robot no way
    errors: tuple[Error, ...] = ()

    @property
    def driving(self) -> bool:
        """True if the robot moves or turns."""
        return abs(self.linear) >= 0.01 or abs(self.angular) >= 0.01


@dataclass(frozen=True)
class Machine:
    """The content of its factsheet; SI units."""

    series: str = "robot_control"
    length: float = 0.0
    width: float = 0.0
    height: float = 0.0
    speed: float = 0.5
    slowest: float = 0.02
    acceleration: float = 0.5
    deceleration: float = 0.3
    wheels: tuple[tuple[float, float, float, float], ...] = ()  # x, y, diameter, width
    description: str = ""
    max_load: float = 0.0
    software: str = ""
    actions: Mapping[str, ActionKind] = field(default_factory=dict)
    visualization_period: float = 0.2


def position(facts: Facts) -> Message:
    """agvPosition."""
    result: Message = {
        "x": facts.x,
        "y": facts.y,
        "theta": turned(facts.theta),
        "mapId": facts.map_id,
        "positionInitialized": bool(facts.map_id),
    }
    return result if facts.deviation is None else result | {"deviationRange": facts.deviation}


def velocity(facts: Facts) -> Message:
    """The velocity of the robot in its own axes."""
    return {"vx": facts.linear, "vy": 0.0, "omega": facts.angular}


def visualization(facts: Facts) -> Message:
    """Without its header."""
    return {"agvPosition": position(facts), "velocity": velocity(facts)}


def state(vehicle: Vehicle, facts: Facts, unknown_charge: float, *, new_base: bool) -> Message:
    """Without its header. `unknown_charge`: % that is reported where no battery is measured."""
    known = facts.battery_charge is not None
    battery: Message = {
        "batteryCharge": facts.battery_charge if facts.battery_charge is not None else unknown_charge,
        "charging": facts.charging,
    }
    if facts.battery_voltage is not None:
        battery["batteryVoltage"] = facts.battery_voltage
    information = [] if known else [_info("batteryUnknown", "no battery is measured; batteryCharge is a setting")]
    if facts.held_by:
        information.append(_info("held", facts.held_by))
    return {
        "orderId": vehicle.order_id,
        "orderUpdateId": vehicle.update_id,
        "lastNodeId": vehicle.last_id,
        "lastNodeSequenceId": vehicle.last_sequence,
        "nodeStates": [_node_state(node) for node in vehicle.nodes],
        "edgeStates": [{"edgeId": e.id, "sequenceId": e.sequence, "released": e.released} for e in vehicle.edges],
        "actionStates": [_action_state(each) for each in vehicle.actions],
        "agvPosition": position(facts),
        "velocity": velocity(facts),
        "driving": facts.driving,
        "paused": vehicle.paused or bool(facts.held_by),
        "newBaseRequest": new_base,
        "batteryState": battery,
        "operatingMode": facts.mode,
        "errors": [error.message() for error in (*vehicle.refusals, *facts.errors)],
        "information": information,
        "safetyState": {"eStop": "MANUAL" if facts.stopped else "NONE", "fieldViolation": False},
    }


def _info(kind: str, text: str) -> Message:
    return {"infoType": kind, "infoDescription": text, "infoLevel": "INFO"}


def _node_state(node: Node) -> Message:
    result: Message = {"nodeId": node.id, "sequenceId": node.sequence, "released": node.released}
    if node.place is not None:
        at = node.raw["nodePosition"]
        result["nodePosition"] = {name: at[name] for name in PLACE if name in at}
    return result


def _action_state(state: ActionState) -> Message:
    result = {"actionId": state.action.id, "actionType": state.action.kind, "actionStatus": state.status}
    return result | ({"resultDescription": state.result} if state.result else {})


def factsheet(machine: Machine) -> Message:
    """Without its header; the limits are those that messages.py enforces."""
    x, y = machine.length / 2, machine.width / 2
    corners = ((x, y), (-x, y), (-x, -y), (x, -y))
    return {
        "typeSpecification": {
            "seriesName": machine.series,
            "seriesDescription": machine.description,
            "agvKinematic": "DIFF",
            "agvClass": "CARRIER",
            "maxLoadMass": machine.max_load,
            "localizationTypes": ["NATURAL"],
            "navigationTypes": ["VIRTUAL_LINE_GUIDED"],
        },
        "physicalParameters": {
            "speedMin": machine.slowest,
            "speedMax": machine.speed,
            "accelerationMax": machine.acceleration,
            "decelerationMax": machine.deceleration,
            "heightMin": machine.height,
            "heightMax": machine.height,
            "width": machine.width,
            "length": machine.length,
        },
        "protocolLimits": _limits(machine),
        "protocolFeatures": {
            "optionalParameters": [
                {"parameter": name, "support": "REQUIRED" if name == OPTIONAL[0] else "SUPPORTED"} for name in OPTIONAL
            ],
            "agvActions": [
                {
                    "actionType": name,
                    "actionDescription": kind.description,
                    "actionScopes": list(kind.scopes),
                    "actionParameters": [
                        {"key": key, "valueDataType": "STRING" if key.endswith("Id") else "NUMBER"}
                        for key in kind.needs
                    ],
                }
                for name, kind in machine.actions.items()
            ],
        },
        "agvGeometry": {
            "wheelDefinitions": [_wheel(*wheel) for wheel in machine.wheels],
            "envelopes2d": [{"set": "body", "polygonPoints": [{"x": x, "y": y} for x, y in corners]}],
        },
        "loadSpecification": {},
        "vehicleConfig": {"versions": [{"key": "robot_control", "value": machine.software}]},
    }


def _limits(machine: Machine) -> Message:
    return {
        "maxStringLens": {"msgLen": MAX_BYTES, "topicSerialLen": MAX_ID, "topicElemLen": MAX_ID, "idLen": MAX_ID},
        "maxArrayLens": {
            "order.nodes": LIMITS["nodes"],
            "order.edges": LIMITS["edges"],
            "node.actions": LIMITS["actions"],
            "edge.actions": LIMITS["actions"],
            "actions.actionsParameters": LIMITS["actionParameters"],
            "instantActions": LIMITS["actions"],
            "trajectory.knotVector": LIMITS["knotVector"],
            "trajectory.controlPoints": LIMITS["controlPoints"],
        },
        "timing": {
            "minOrderInterval": 0.1,
            "minStateInterval": 0.02,
            "defaultStateInterval": STATE_PERIOD,
            "visualizationInterval": machine.visualization_period,
        },
    }


def _wheel(x: float, y: float, diameter: float, width: float) -> Message:
    return {
        "type": "DRIVE",
        "isActiveDriven": True,
        "isActiveSteered": False,
        "position": {"x": x, "y": y, "theta": 0.0},
        "diameter": diameter,
        "width": width,
    }
