"""``python -m roomba_bench.ros.echo KIND``: a bare node that sends back what comes on ``ping``."""

from __future__ import annotations

import sys

import rospy

from roomba_bench.ros.messages import KINDS

message = KINDS[sys.argv[1]].message
rospy.init_node("echo", anonymous=True)
pong = rospy.Publisher("pong", message, queue_size=1, tcp_nodelay=True)
rospy.Subscriber("ping", message, pong.publish, queue_size=1, tcp_nodelay=True)
rospy.spin()
